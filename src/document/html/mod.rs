//! A page as one HTML document.

use maud::{DOCTYPE, Markup, PreEscaped, html as markup};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde_json::{Value, json};

mod chart;
mod policy;

use super::{Block, Cell, Document, Panel, Section, Strip, Table, Tone};
use super::{address, first_sentence, packed};
use crate::quantity::capital;

const STYLE: &str = include_str!("../../../assets/page/page.css");
const CHART_STYLE: &str = include_str!("../../../assets/page/uplot/uPlot.min.css");
const CHART_SCRIPT: &str = include_str!("../../../assets/page/uplot/uPlot.iife.min.js");
const SCRIPT: &str = include_str!("../../../assets/page/page.js");
const SPACE_LIBRARY: &str = include_str!("../../../assets/page/three/three.iife.min.js");
const SPACE_SCRIPT: &str = include_str!("../../../assets/page/drawing.js");
/// Letters that are encoded in a picture's address. Its images are in base64, whose letters stay, so that it does not grow by much.
const WITHIN_DATA: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'_')
    .remove(b'.')
    .remove(b'/')
    .remove(b'+')
    .remove(b'=')
    .remove(b',')
    .remove(b':')
    .remove(b';');
/// Numbers on a page at most: four bytes and a third of text each, of which a report of a run has half in use, so that it stays below 1.5 MB.
const MOST_NUMBERS: usize = 240_000;
/// Numbers that small charts keep beside large ones: of all charts, and of one at most.
const LEAST_NUMBERS: [usize; 2] = [150_000, 4000];

/// Resources that the parts of a page share.
struct Budget {
    /// Share of its numbers that a chart may keep [1].
    share: f64,
    /// Numbers that it may keep in any case.
    least: usize,
}

/// The page as a document.
#[must_use]
pub fn html(page: &Document<'_>) -> String {
    let counts = page.sections.iter().map(|s| numbers(&s.blocks));
    let (charts, all) = counts.fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    let budget = Budget {
        share: (MOST_NUMBERS as f64 / all.max(1) as f64).min(1.0),
        least: (LEAST_NUMBERS[0] / charts.max(1)).min(LEAST_NUMBERS[1]),
    };
    let tone = match page.tone {
        Tone::Plain => "verdict",
        Tone::Good => "verdict good",
        Tone::Found => "verdict found",
        Tone::Open => "verdict open",
        Tone::Bad => "verdict bad",
    };
    let in_space = page.sections.iter().any(|part| in_space(&part.blocks));
    let mut scripts = vec![CHART_SCRIPT, SCRIPT];
    if in_space {
        scripts.extend([SPACE_LIBRARY, SPACE_SCRIPT]);
    }
    markup! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy::of(&scripts));
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (page.title) }
                link rel="icon" href="data:,";
                style { (PreEscaped(CHART_STYLE)) (PreEscaped(STYLE)) }
            }
            body {
                header {
                    div.top { h1 { (page.title) } button #theme type="button" { "Light or dark" } }
                    p class=(tone) { (page.verdict) }
                    @for text in &page.lead { p.lead { (text) } }
                    @if !page.facts.is_empty() {
                        dl.facts { @for fact in &page.facts {
                            div { dt { (fact.name) } dd data-key=[key(&fact.value)] { (fact.value.words()) @if !fact.remark.is_empty() { small { (bound(&fact.remark)) } } } }
                        } }
                    }
                    @if page.sections.len() > 1 { nav aria-label="Contents" { @for section in &page.sections {
                        a href={ "#" (anchor(&section.title)) } { (section.title) }
                    } } }
                    noscript { p { "Charts, and drawings that turn, need JavaScript; all numbers stand in the tables." } }
                }
                main { @for part in &page.sections { (section(part, &budget)) } }
                footer { (page.footer) }
                script { (PreEscaped(CHART_SCRIPT)) }
                script { (PreEscaped(SCRIPT)) }
                @if in_space {
                    script #space-library type="application/gzip" { (PreEscaped(packed::gzip(SPACE_LIBRARY.as_bytes()))) }
                    script { (PreEscaped(SPACE_SCRIPT)) }
                }
            }
        }
    }
    .into_string()
}

/// Charts, and their numbers.
fn numbers(blocks: &[Block<'_>]) -> (usize, usize) {
    let of = |block: &Block<'_>| match block {
        Block::Panel(panel) => (1, panel.numbers()),
        Block::Folded(_, blocks) => numbers(blocks),
        _ => (0, 0),
    };
    let counts = blocks.iter().map(of);
    counts.fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
}

/// Whether there is a drawing in space.
fn in_space(blocks: &[Block<'_>]) -> bool {
    blocks.iter().any(|block| match block {
        Block::InSpace(..) => true,
        Block::Folded(_, blocks) => in_space(blocks),
        _ => false,
    })
}

fn section(part: &Section<'_>, budget: &Budget) -> Markup {
    markup! {
        section id=(anchor(&part.title)) {
            h2 { (part.title) }
            @for one in &part.blocks { (block(one, budget)) }
        }
    }
}

fn block(block_of: &Block<'_>, budget: &Budget) -> Markup {
    markup! {
        @match block_of {
            Block::Heading(text) => h3 { (text) },
            Block::Paragraph(text) => p { (bound(text)) },
            Block::Hint(text) => p.hint { (bound(text)) },
            Block::Table(of) if of.rows.is_empty() => p.hint { (of.caption) " None." },
            Block::Table(of) => (table(of)),
            Block::Panel(of) if nothing_happened(of) => p { b { (capital(&of.title)) } ": 0 throughout." },
            Block::Panel(of) => (chart(of, budget)),
            Block::Strip(of) if of.rows.iter().all(|(_, spans)| spans.is_empty()) => p.hint { "At no time." },
            Block::Strip(of) => (strip(of)),
            Block::Lines(text) => pre { (text) },
            Block::Sketches(all) => (sketches(all)),
            Block::InSpace(drawing, instead) => div.space {
                (sketches(instead))
                script type="application/json" { (PreEscaped(within_script(&json!(drawing)))) }
            },
            Block::File(name, words) => p { a href=(address(name)) { (name) } ": " (words) },
            Block::Folded(summary, blocks) => details {
                summary { (summary) }
                @for one in blocks { (block(one, budget)) }
            },
        }
    }
}

/// Whether all that a chart would show is a line at zero.
fn nothing_happened(panel: &Panel<'_>) -> bool {
    let mut values = panel.series.iter().flat_map(|series| series.values.iter());
    values.all(|value| *value == 0.0 || value.is_nan())
}

/// Pictures as images: in one, whoever drew it, no script runs, nothing is fetched, and nothing reaches the page.
fn sketches(all: &[(String, String)]) -> Markup {
    markup! {
        div.sketches { @for (words, svg) in all {
            figure { img src=(picture(svg)) alt=(first_sentence(words)); figcaption { (words) } }
        } }
    }
}

/// An SVG document as an address.
fn picture(svg: &str) -> String {
    format!(
        "data:image/svg+xml,{}",
        utf8_percent_encode(svg, WITHIN_DATA)
    )
}

/// Data in a script, within which `</script>` would end it, and `<!--<script>` hide its end.
fn within_script(data: &Value) -> String {
    data.to_string().replace('<', "\\u003c")
}

fn chart(panel: &Panel<'_>, budget: &Budget) -> Markup {
    let columns = panel.series.len() + 1;
    let share = (budget.share * panel.numbers() as f64) as usize;
    let most = share.max(budget.least) / columns;
    let (data, [kept, of]) = panel.data(most);
    let data = within_script(&data);
    let picked = match panel.is_cloud() {
        true => "an even pick",
        false => "the extremes of each stretch",
    };
    markup! {
        figure.chart aria-label={ (panel.title) ": " (panel.vertical_label) } {
            figcaption {
                span { (capital(&panel.title)) @if kept < of { small { " (" (kept) " of " (of) " samples: " (picked) ")" } } }
                button.reset type="button" { "Show all" }
            }
            div.plot {}
            script type="application/json" { (PreEscaped(data)) }
        }
    }
}

/// Key of the file that has every digit of a number.
fn key(cell: &Cell) -> Option<&str> {
    match cell {
        Cell::Number(number) if !number.key.is_empty() => Some(&number.key),
        _ => None,
    }
}

fn table(table: &Table) -> Markup {
    let numeric = |index: usize| table.columns[index].is_numeric.then_some("number");
    markup! {
        div.scroll { table.sortable[table.is_sortable] {
            @if !table.caption.is_empty() { caption { (table.caption) } }
            thead { tr { @for (index, column) in table.columns.iter().enumerate() { th class=[numeric(index)] scope="col" { (column.name) } } } }
            tbody { @for row in &table.rows { tr { @for (index, cell) in row.iter().enumerate() {
                @match cell {
                    Cell::Text(text) => td class=[numeric(index)] { (text) },
                    Cell::Number(number) => td class=[numeric(index)] data-key=[key(cell)] { (number.with_unit()) },
                    Cell::Verdict(text, good) => td class={ @if *good { "good " } @else { "bad " } (numeric(index).unwrap_or_default()) } { (text) },
                    Cell::Hash(text) => td.hash { (text) },
                    Cell::Link(text, target) => td { a href=(address(target)) { (text) } },
                    Cell::Interval(ends) => td { (interval(*ends)) },
                }
            } } } }
        } }
    }
}

/// A bar from low to high, the value a line in it, over all that is drawn beside it.
fn interval([least, low, value, high, most]: [f64; 5]) -> Markup {
    let width = (most - least).max(f64::MIN_POSITIVE);
    let at = |v: f64| 100.0 * ((v - least) / width).clamp(0.0, 1.0);
    let bar = format!("left:{:.2}%;width:{:.2}%", at(low), at(high) - at(low));
    let line = format!("left:{:.2}%", at(value));
    markup! { span.interval role="img" aria-label="interval" { i style=(bar) {} b style=(line) {} } }
}

fn strip(strip: &Strip) -> Markup {
    let [first, last] = strip.span;
    let width = (last - first).max(f64::MIN_POSITIVE);
    let place = |[from, to]: [f64; 2]| {
        let at = |t: f64| 100.0 * ((t - first) / width).clamp(0.0, 1.0);
        format!("left:{:.3}%;width:{:.3}%", at(from), at(to) - at(from))
    };
    markup! {
        h3 { (strip.title) }
        div.strip {
            @for (name, spans) in &strip.rows {
                span.name { (name) }
                span.bar { @for span in spans { i style=(place(*span)) title={ (format!("{:.2} to {:.2} s", span[0], span[1])) } {} } }
            }
            span {}
            span.ends { span { (format!("{first:.1} s")) } span { (format!("{last:.1} s")) } }
        }
    }
}

/// A text in which a number stays with its percent sign.
fn bound(text: &str) -> String {
    text.replace(" %", "\u{a0}%")
}

/// A heading as an address within the page.
fn anchor(title: &str) -> String {
    let letter = |c: char| match c.is_ascii_alphanumeric() {
        true => c.to_ascii_lowercase(),
        false => '-',
    };
    title.chars().map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Column, Panel, Role, Series, Stroke};

    #[test]
    fn where_nothing_happened_is_one_line() {
        let chart = |values: Vec<f64>| {
            let times = vec![0.0, 1.0];
            let series = Series::new("force", times, values, Role::Force, Stroke::Plain);
            let panel = Panel {
                title: "Seals".to_owned(),
                series: vec![series],
                ..Panel::default()
            };
            html(&Document {
                sections: vec![Section::new("All", vec![Block::Panel(panel)])],
                ..Document::default()
            })
        };
        let still = chart(vec![0.0, -0.0]);
        assert!(still.contains("<b>Seals</b>: 0 throughout.") && !still.contains("<figure"));
        assert!(chart(vec![0.0, 1e-9]).contains("<figure"));
        let table = Table::new("Changes.", vec![Column::of_words("day")], Vec::new());
        let text = html(&Document {
            sections: vec![Section::new("All", vec![Block::Table(table)])],
            ..Document::default()
        });
        assert!(text.contains("Changes. None.") && !text.contains("<table"));
    }

    #[test]
    fn a_page_holds_all_and_asks_for_nothing() {
        let long = || -> Vec<f64> { (0..600_000).map(|i| f64::from(i % 977)).collect() };
        let ends_it = "</script><b>";
        let hides_its_end = "<!--<script>";
        let series = Series::new(ends_it, long(), long(), Role::Force, Stroke::Plain);
        let chart = Panel {
            title: ends_it.to_owned(),
            series: vec![series],
            group: hides_its_end.to_owned(),
            ..Panel::default()
        };
        let page = Document {
            title: "A & B".to_owned(),
            sections: vec![Section::new("All of it", vec![Block::Panel(chart)])],
            ..Document::default()
        };
        let text = html(&page);
        assert!(text.len() < 3_000_000, "{}", text.len());
        assert!(text.contains("A &amp; B") && text.contains("id=\"all-of-it\""));
        assert!(!text.contains(ends_it) && !text.contains(hides_its_end));
        let (_, rest) = text
            .split_once("<script type=\"application/json\">")
            .unwrap();
        let (data, _) = rest.split_once("</script>").unwrap();
        let data: serde_json::Value = serde_json::from_str(data).unwrap();
        assert_eq!(data["series"][0]["label"], ends_it);
        assert_eq!(data["group"], hides_its_end);
        let fetched = ["src=\"http", "href=\"http", "url(http", "@import"];
        assert!(fetched.iter().all(|way| !text.contains(way)));
        assert_eq!(text, html(&page));
    }

    #[test]
    fn a_picture_is_an_image_and_a_name_no_command() {
        let svg = "<svg onload=\"alert(1)\"><script>alert(2)</script></svg>";
        let pictures = || vec![("a \"b\" <i>".to_owned(), svg.to_owned())];
        let drawing = crate::document::Drawing::default();
        let link = Cell::Link("x".to_owned(), "javascript:alert(3)".to_owned());
        let blocks = vec![
            Block::Sketches(pictures()),
            Block::InSpace(&drawing, pictures()),
            Block::Table(Table::new("", Column::list("a"), vec![vec![link]])),
            Block::File("//a.example/x?y#z".to_owned(), String::new()),
        ];
        let text = html(&Document {
            sections: vec![Section::new("All", blocks)],
            ..Document::default()
        });
        assert!(!text.contains("<svg onload"));
        let (_, image) = text.split_once("src=\"data:image/svg+xml,").unwrap();
        let (data, _) = image.split_once('"').unwrap();
        let decoded = percent_encoding::percent_decode_str(data).decode_utf8();
        assert_eq!(decoded.unwrap(), svg);
        assert!(text.contains("alt=\"a &quot;b&quot; &lt;i&gt;\""));
        assert!(text.contains("href=\"javascript%3Aalert%283%29\""));
        assert!(text.contains("href=\"/a.example/x%3Fy%23z\""));
    }

    #[test]
    fn an_interval_is_drawn_where_its_numbers_are() {
        let drawn = interval([0.0, 2.0, 3.0, 4.0, 10.0]).into_string();
        assert!(drawn.contains("left:20.00%;width:20.00%") && drawn.contains("left:30.00%"));
    }
}
