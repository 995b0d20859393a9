//! A plan as Snakemake takes it.

use std::path::Path;

use super::store::{RESULT, TASKS};

/// The file for Snakemake of a plan that a program does.
#[must_use]
pub fn snakefile(program: &Path, plan: &Path) -> String {
    let text = |path: &Path| serde_json::Value::from(path.display().to_string()).to_string();
    let folder = plan.parent().unwrap_or(Path::new(""));
    format!(
        "\
# Written by `idc task PLAN --export snakemake`: snakemake --snakefile THIS --cores all
# Exit codes 1, 2 and 3 are results; what counts is whether the task's folder stands, which is renamed when it is whole.
import json

IDC = {program}
PLAN = {plan}
TASKS = {tasks}

with open(PLAN) as lines:
    next(lines)
    AFTER = {{task[\"id\"]: task.get(\"after\") for task in map(json.loads, lines)}}


def result(name):
    return f\"{{TASKS}}/{{name}}/{RESULT}\"


rule all:
    input:
        [result(name) for name in AFTER],


rule task:
    input:
        lambda wildcards: [result(AFTER[wildcards.id])] if AFTER[wildcards.id] else [],
    output:
        result(\"{{id}}\"),
    wildcard_constraints:
        id=\"[0-9a-f]{{64}}\",
    shell:
        \"{{IDC:q}} task {{PLAN:q}} {{wildcards.id}} || test -f {{output:q}}\"
",
        program = text(program),
        plan = text(plan),
        tasks = text(&folder.join(TASKS)),
    )
}
