//! How robust the chosen design is, as lines of the table.

use super::super::label::number;
use super::super::result::StudyResult;
use super::super::robustness::KeptShare;
use super::{columns, heading, line, named_line, row};

pub(super) fn robustness(out: &mut String, result: &StudyResult) {
    let Some(robustness) = &result.robustness else {
        return;
    };
    out.push('\n');
    let title = format!("Robustness: {} draws at the chosen design", robustness.runs);
    line(out, &format!("{title:<48} {:>7}  95 % interval", "keep"));
    shared(out, "all limits", &robustness.all_limits);
    for limit in &robustness.limits {
        shared(out, &limit.limit, &limit.share);
    }
    heading(
        out,
        "Quantiles of the draws",
        &columns(["5 %", "50 %"], "95 %"),
    );
    for told in &robustness.quantiles {
        let ends = [told.percent_5, told.percent_50].map(number);
        row(out, &told.metric, ends, &number(told.percent_95));
    }
    for (reason, count) in &robustness.failed {
        line(out, &format!("  {count:>6}  {reason}"));
    }
}

fn shared(out: &mut String, name: &str, share: &KeptShare) {
    let [low, high] = share.interval_percent;
    let told = format!("{:>5.0} %  {low:.0} to {high:.0} %", share.share_percent);
    named_line(out, &format!("  {name}"), 49, &told);
}
