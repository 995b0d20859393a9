"""What the recomputations share: the program, printed numbers to their last digit, pages, the viewer's text."""

import html.parser
import math
import os
import re
import subprocess
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
IDC = PROJECT / os.environ.get("IDC", "target/release/idc")
RESULTS = PROJECT / "build/recomputed"

RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
# A number as it is printed: `319.6`, `-0.012`, `<0.001`, `+1.5`, `3.1·10⁻¹³`, or a dash for one that is not determined.
NUMBER = r"[<>]?[-−+]?\d+(?:\.\d+)?(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?"
PRINTED = rf"(?:{NUMBER}|–|undefined)"


def run(*words, codes=(0,)):
    """Runs the program in the project's root and returns what it prints."""
    done = subprocess.run([IDC, *map(str, words)], cwd=PROJECT, capture_output=True, text=True)
    if done.returncode not in codes:
        raise SystemExit(f"idc {' '.join(map(str, words))} ended with {done.returncode}:\n{done.stderr}")
    return done.stdout


def agrees(text, value):
    """Is a printed number the value, to within half of its last digit? `<0.001`: it rounds to nothing; `<100`: it falls short."""
    text = text.strip().replace("−", "-")
    if text in ("–", "undefined"):
        return value is None
    if value is None or not math.isfinite(value):
        return False
    if text == "<100":
        return 99.995 <= value < 100.0
    sign = text[0] if text[0] in "<>" else ""
    front, _, power = text.lstrip("<>").partition("·10")
    scale = 10.0 ** int(power.translate(RAISED)) if power else 1.0
    decimals = len(front.partition(".")[2])
    last = scale * 10.0**-decimals
    near = 0.5 * last * (1 + 1e-6) + 1e-12 * abs(value)
    if sign == "<":
        return abs(value) <= near and value != 0.0
    if sign == ">":
        return -near <= value < 0.0
    return abs(value - scale * float(front)) <= near


class Checked:
    """Counts what was compared, and keeps what did not agree and what no definition covers."""

    def __init__(self, name):
        self.name, self.compared, self.wrong = name, 0, []

    def number(self, where, text, value):
        self.compared += 1
        if not agrees(text, value):
            self.wrong.append(f"{self.name}: {where}: {text} is printed, {value!r} recomputed")

    def exact(self, where, found, value, relative=1e-9):
        """A number of a file, which keeps all digits."""
        self.compared += 1
        if found is None or value is None:
            fits = found is None and value is None
        else:
            fits = abs(found - value) <= max(relative * abs(value), 1e-12)
        if not fits:
            self.wrong.append(f"{self.name}: {where}: {found!r} in the file, {value!r} recomputed")

    def fact(self, where, found, expected):
        self.compared += 1
        if found != expected:
            self.wrong.append(f"{self.name}: {where}: {found!r}, expected {expected!r}")

    def uncovered(self, where, text):
        self.wrong.append(f"{self.name}: {where}: no definition covers `{text}`")

    def sentence(self, where, text, templates, numbers):
        """Compares a sentence with the first template that it fits: `{key}` is the printed number of that key."""
        text = " ".join(text.replace("\u00a0", " ").split())
        for template in templates:
            keys = re.findall(r"\{(\w+)\}", template)
            parts = re.split(r"\{\w+\}", template)
            found = re.fullmatch(rf"({PRINTED})".join(map(re.escape, parts)), text)
            if found:
                for key, printed in zip(keys, found.groups()):
                    if key not in numbers:
                        self.uncovered(where, f"{key}: {printed}")
                    else:
                        self.number(f"{where}: {key}", printed, numbers[key])
                return True
        if re.search(r"\d", text):
            self.uncovered(where, text)
        return False


class Page(html.parser.HTMLParser):
    """What of a page is seen: tables, facts, and texts by the elements that they stand in."""

    VOID = {"meta", "link", "br", "image", "line", "rect", "circle", "polygon", "input", "img"}

    def __init__(self, text):
        super().__init__()
        self.open, self.texts, self.tables, self.charts = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "table":
            self.tables.append({"caption": "", "head": [], "rows": []})
        if tag == "tr" and self.tables:
            self.tables[-1]["rows"].append([])
        if tag in ("td", "th"):
            row = self.tables[-1]["rows"][-1]
            row.append("")
        if tag not in self.VOID:
            self.open.append((tag, attributes.get("class", "")))
        if tag in ("p", "dt", "dd", "figcaption", "text", "h1", "h2", "h3", "footer", "small", "span", "summary", "a", "button"):
            self.texts.append([tag, attributes.get("class", ""), ""])

    def handle_startendtag(self, tag, attributes):
        pass

    def handle_endtag(self, tag):
        while self.open:
            last, _ = self.open.pop()
            if last == tag:
                break

    def handle_data(self, data):
        tags = [tag for tag, _ in self.open]
        if "script" in tags:
            if ("plot" not in tags) and data.lstrip().startswith("{"):
                self.charts.append(data)
            return
        if "style" in tags or "title" in tags:
            return
        if "caption" in tags:
            self.tables[-1]["caption"] += data
        elif tags and ("td" in tags or "th" in tags):
            self.tables[-1]["rows"][-1][-1] += data
        elif self.texts and data.strip():
            self.texts[-1][2] += data

    def table(self, first):
        """The table whose head begins with a word."""
        return next((table for table in self.tables if table["rows"] and table["rows"][0][0] == first), None)


def viewer_text(recording):
    """The Markdown that the viewer shows of a recording: its static text `/summary`."""
    from rerun.experimental import RrdReader

    for chunk in RrdReader(recording).stream():
        if str(chunk.entity_path) == "/summary":
            batch = chunk.to_record_batch()
            for name in batch.schema.names:
                if name.endswith("TextDocument:text") or name.endswith(":text"):
                    return batch.column(name)[0].as_py()[0]
    raise SystemExit(f"{recording}: no text at /summary")


def markdown_tables(text):
    """Rows of the tables of a Markdown text, cells unescaped, and its other lines."""
    tables, others = [], []
    for line in text.splitlines():
        if line.startswith("|"):
            cells = [re.sub(r"\\(.)", r"\1", cell.strip()) for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            if all(re.fullmatch(r"-+:?", cell) for cell in cells):
                continue
            if tables and tables[-1]["open"]:
                tables[-1]["rows"].append(cells)
            else:
                tables.append({"open": True, "rows": [cells]})
        else:
            if tables:
                tables[-1]["open"] = False
            if line.strip():
                others.append(re.sub(r"\\(.)", r"\1", line.strip()))
    return [table["rows"] for table in tables], others
