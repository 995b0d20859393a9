#!/usr/bin/env python3
"""Logs in some 150 dialects, each with a known truth: what `idc new import` and `idc import` make of them.

    python3 tests/studies/log_dialects.py target/release/idc [--keep DIR] [--seed 1] [--only NAME]

Each log is read by the map drafted from it, without an edit, and its recording is held against the truth: times from the first sample, and every value.
It prints how many logs are read rightly, refused (by the draft's open question or by the import, with the reason), read with a doubt or an open question that names what is wrong,
and MISREAD IN SILENCE, of which there must be none. Needs pyarrow, to read what was written; exit code 1 if a log is misread in silence or refused for another reason than the one expected.
"""

import argparse
import datetime
import json
import math
import os
import random
import subprocess
import sys
import tempfile

ROWS = 600


class Truth:
    """Readings of a device: set and outlet pressure [bar, gauge], force [N]."""

    def __init__(self, seed, rows=ROWS, step=0.01):
        draw = random.Random(seed)
        self.step = step
        self.time = [step * i for i in range(rows)]
        self.p_set, self.p_out, self.force = [], [], []
        out = 0.0
        for i in range(rows):
            wanted = 0.0 if i < rows // 5 else 2.0 if i < 4 * rows // 5 else 3.5
            out += (wanted - out) * min(1.0, step / 0.08)
            self.p_set.append(wanted)
            self.p_out.append(out + draw.gauss(0, 0.004))
            self.force.append(60.0 * out + draw.gauss(0, 0.5))


def number(value, digits, mark=".", thousands="", minus="-"):
    text = f"{abs(value):.{digits}f}"
    whole, _, decimals = text.partition(".")
    if thousands and len(whole) > 3:
        groups = []
        while whole:
            groups.insert(0, whole[-3:])
            whole = whole[:-3]
        whole = thousands.join(groups)
    sign = minus if value < 0 and float(text) != 0 else ""
    return sign + whole + (mark + decimals if decimals else "")


class Log:
    """A log to be: name, text, what is right, and what may be said instead."""

    def __init__(self, name, text, truth, may=("read",), reason="", ending="csv", tolerance=None, start=0):
        self.name, self.text, self.truth = name, text, truth
        self.may, self.reason, self.ending = may, reason, ending
        self.tolerance = tolerance or {}
        self.start = start


def table(truth, times, separator=",", mark=".", head=None, digits=(2, 4, 2), rows=None, thousands="", minus="-", quote=False, end="\n", scale=(1, 1, 1)):
    names = ["t [s]", "p_set [bar]", "p_out [bar]", "F [N]"] if head is None else head
    lines = [separator.join(names)] if names else []
    for i in rows or range(len(truth.time)):
        cells = [times(i)] + [
            number(factor * values[i], places, mark, thousands, minus)
            for values, places, factor in zip((truth.p_set, truth.p_out, truth.force), digits, scale)
        ]
        if quote:
            cells = [f'"{cell}"' for cell in cells]
        lines.append(separator.join(cells))
    return end.join(lines) + end


def logs(seed):
    t = Truth(seed)
    found = []

    def add(name, text, may=("read",), reason="", truth=t, **more):
        found.append(Log(name, text, truth, may, reason, **more))

    def seconds(mark=".", digits=2):
        return lambda i: number(t.time[i], digits, mark)

    head = ["t [s]", "p_set [bar]", "p_out [bar]", "F [N]"]
    # Separators, marks and ends of lines.
    for separator, name in [(",", "comma"), (";", "semicolon"), ("\t", "tab"), ("|", "bar"), (" ", "space"), ("   ", "spaces")]:
        own = head if separator.strip() else ["t_s", "p_set_bar", "p_out_bar", "F_N"]
        own = own if separator != "\t" else head
        for mark in ".,":
            if mark == separator:
                continue
            for end, of_end in [("\n", "lf"), ("\r\n", "crlf")]:
                add(f"sep_{name}_{'point' if mark == '.' else 'comma'}_{of_end}", table(t, seconds(mark), separator, mark, own, end=end))
    add("quoted_comma", table(t, seconds(","), ",", ",", quote=True))
    add("quoted_comma_names", table(t, seconds(","), ",", ",", head=[f'"{n}"' for n in head], quote=True))
    add("quoted_semicolon", table(t, seconds(","), ";", ",", quote=True))
    add("quoted_point", table(t, seconds(), ",", ".", quote=True))
    unquoted = table(t, seconds(","), ",", ",")
    add("unquoted_comma_twice", unquoted, ("refused",), "")
    # Thousands and minus signs.
    pascal = ["t [s]", "p_set [Pa]", "p_out [Pa]", "F [N]"]
    for sign, name in [("\u00a0", "nbsp"), ("\u2009", "thin"), ("\u202f", "narrow"), ("\u2007", "figure"), ("'", "swiss"), ("\u2019", "apostrophe"), (",", "english"), (" ", "space")]:
        add(f"thousands_{name}", table(t, seconds(), ";", ".", pascal, digits=(0, 0, 2), thousands=sign, scale=(1e5, 1e5, 1)), tolerance={"p": 1.0})
    for sign, name in [("\u00a0", "nbsp"), (".", "point"), (" ", "space")]:
        add(f"thousands_comma_{name}", table(t, seconds(","), ";", ",", pascal, digits=(0, 0, 2), thousands=sign, scale=(1e5, 1e5, 1)), tolerance={"p": 1.0})
    for sign, name in [("\u2212", "u2212"), ("\u2013", "dash"), ("\uff0d", "wide"), ("\ufe63", "small")]:
        add(f"minus_{name}", table(t, seconds(), minus=sign))
        add(f"minus_{name}_comma", table(t, seconds(","), ";", ",", minus=sign))
    # Encodings.
    german = ["Zeit [s]", "Solldruck [bar]", "Druck Ausgang [bar]", "Kraft für Prüfung [N]"]
    for encoding in ["utf-8", "utf-8-sig", "cp1252", "utf-16", "utf-16-le", "utf-16-be"]:
        add(f"encoding_{encoding}", table(t, seconds(","), ";", ",", german).encode(encoding))
    add("encoding_cp850", table(t, seconds(","), ";", ",", german).encode("cp850"), ("refused",), "encoding")
    # Stamps.
    origin = datetime.datetime(2024, 1, 18, 9, 10, 0)

    def at(i, step=t.step, origin=origin):
        return origin + datetime.timedelta(microseconds=round(i * step * 1e6))

    def clock(form, cut=3):
        def text(i):
            moment = at(i)
            return moment.strftime(form) + f".{moment.microsecond:06d}"[: cut + 1]

        return text

    stamped = ["Time", "p_set [bar]", "p_out [bar]", "F [N]"]
    for name, times in {
        "iso": clock("%Y-%m-%dT%H:%M:%S"),
        "iso_z": lambda i: clock("%Y-%m-%dT%H:%M:%S")(i) + "Z",
        "iso_zone": lambda i: clock("%Y-%m-%dT%H:%M:%S", 6)(i) + "+01:00",
        "iso_space": clock("%Y-%m-%d %H:%M:%S", 6),
        "german": clock("%d.%m.%Y %H:%M:%S"),
        "slashed_ymd": clock("%Y/%m/%d %H:%M:%S"),
        "british": clock("%d/%m/%Y %H:%M:%S"),
        "american": clock("%m/%d/%Y %H:%M:%S"),
        "month_name": clock("%d-%b-%Y %H:%M:%S"),
        "compact": clock("%Y%m%dT%H%M%S"),
        "day_time": clock("%H:%M:%S"),
        "tod": lambda i: "TOD#" + clock("%H:%M:%S")(i),
        "ltod": lambda i: "LTOD#" + clock("%H:%M:%S", 6)(i),
        "dt": lambda i: "DT#" + clock("%Y-%m-%d-%H:%M:%S")(i),
        "timedelta": lambda i: f"0 days {datetime.timedelta(0) + datetime.timedelta(microseconds=round(1e4 * i))!s:0>8}" if i % 100 else f"0 days 00:00:{i // 100:02d}",
        "timedelta_long": lambda i: f"0 days 00:00:{i // 100:02d}.{i % 100:02d}0000",
        "span_net": lambda i: f"0.00:00:{i // 100:02d}.{i % 100:02d}00000",
        "iso_span": lambda i: f"PT{i * 0.01:.3f}S",
        "pandas_span": lambda i: f"P0DT0H0M{i * 0.01:.6f}S",
        "iec": lambda i: f"T#{i // 100}s{i % 100 * 10}ms",
        "iec_ms": lambda i: f"T#{i * 10}ms",
        "mmss": lambda i: f"00:{i // 100:02d}.{i % 100:02d}",
        "hhmmss": lambda i: f"00:00:{i // 100:02d}.{i % 100:02d}",
        "am_pm": lambda i: clock("%m/%d/%Y %I:%M:%S")(i) + " AM",
    }.items():
        add(f"stamp_{name}", table(t, times, ";", ".", stamped))
        if name in ("german", "mmss", "day_time"):
            add(f"stamp_{name}_comma", table(t, lambda i, times=times: ",".join(times(i).rsplit(".", 1)), ";", ",", stamped))
    slow = Truth(seed, 600, 0.1)
    tenth = lambda i: f"{i // 600:02d}:{i // 10 % 60:02d}.{i % 10}"
    add("mmss_tenth", table(slow, tenth, ",", ".", stamped), truth=slow)
    add("mmss_turn", table(slow, lambda i: f"{(i + 35400) // 600 % 60:02d}:{(i + 35400) // 10 % 60:02d}.{i % 10}", ",", ".", stamped), truth=slow)
    early = datetime.datetime(2024, 3, 5, 9, 10, 0)
    add("date_either", table(t, lambda i: (early + datetime.timedelta(milliseconds=10 * i)).strftime("%d/%m/%Y %H:%M:%S.%f"), ";", ".", stamped), ("refused",), "date_order")
    add("date_two_digits", table(t, lambda i: (origin + datetime.timedelta(milliseconds=10 * i)).strftime("%y-%m-%d %H:%M:%S.%f"), ";", ".", stamped), ("refused",), "date_order")
    add("no_year", table(t, clock("%d.%m. %H:%M:%S"), ";", ".", stamped), ("refused",), "year")
    minutes = Truth(seed, 600, 1.0)
    add("two_numbers", table(minutes, lambda i: f"{i // 60:02d}:{i % 60:02d}", ";", ".", stamped), ("refused",), "two_numbers", truth=minutes)
    add("stamp_coarse", table(t, clock("%Y-%m-%d %H:%M:%S", -1), ";", ".", stamped), ("refused",), "sample_rate_hz")
    add("stamp_coarse_day", table(t, clock("%H:%M:%S", -1), ";", ".", stamped), ("refused",), "sample_rate_hz")
    add("seconds_coarse", table(t, lambda i: f"{i // 100}", ";", ".", head), ("refused",), "sample_rate_hz")
    add("date_apart", "\n".join([";".join(["Date"] + stamped)] + [at(i).strftime("%d.%m.%Y;") + line for i, line in enumerate(table(t, clock("%H:%M:%S"), ";", ".", []).splitlines())]) + "\n")
    # Numbers as times.
    unix = 1705569000
    for name, label, times, may, reason in [
        ("s_unsaid", "t", lambda i: f"{i * 0.01:.2f}", ("read",), ""),
        ("ms_unsaid", "Zeit", lambda i: f"{i * 10}", ("read",), ""),
        ("us_unsaid", "time", lambda i: f"{i * 10000}", ("read",), ""),
        ("ms_said", "t [ms]", lambda i: f"{i * 10}", ("read",), ""),
        ("ms_word", "Time (msec)", lambda i: f"{i * 10}", ("read",), ""),
        ("min_said", "t [min]", lambda i: f"{i / 6000:.7f}", ("read",), ""),
        ("unix_s", "timestamp", lambda i: f"{unix + i * 0.01:.2f}", ("read",), ""),
        ("unix_ms", "timestamp", lambda i: f"{unix * 1000 + i * 10}", ("read",), ""),
        ("unix_us", "timestamp", lambda i: f"{unix * 10**6 + i * 10**4}", ("read",), ""),
        ("unix_ns", "timestamp", lambda i: f"{unix * 10**9 + i * 10**7}", ("read",), ""),
        ("filetime", "Time", lambda i: f"{(unix + 11644473600) * 10**7 + i * 10**5}", ("read",), ""),
        ("dotnet", "Ticks", lambda i: f"{(unix + 62135596800) * 10**7 + i * 10**5}", ("read",), ""),
        ("excel_days", "Zeit", lambda i: f"{45309 + (33000 + i * 0.01) / 86400:.10f}", ("read",), ""),
        ("matlab_days", "time", lambda i: f"{739269 + (33000 + i * 0.01) / 86400:.10f}", ("read",), ""),
        ("labview_s", "Time", lambda i: f"{unix + 2082844800 + i * 0.01:.2f}", ("read",), ""),
        ("ones", "time", lambda i: f"{i}", ("refused",), "unit"),
        ("unnamed_ones", "", lambda i: f"{i}", ("refused",), "sample_rate_hz"),
    ]:
        add(f"number_{name}", table(t, times, ";", ".", [label] + head[1:]), may, reason, tolerance={"t": 1e-5})
    # Counters.
    for label in ["Sample", "Nr", "Nr.", "#", "No.", "Index", "n", "Count", "Zeile", "Lfd. Nr.", "Record", "Scan #"]:
        add(f"counter_{label}", table(t, lambda i: f"{i}", ";", ".", [label] + head[1:]), ("refused",), "sample_rate_hz")
    add("counter_from_1", table(t, lambda i: f"{i + 1}", ";", ".", ["Sample"] + head[1:]), ("refused",), "sample_rate_hz")
    for said in ["Sample rate;100;Hz", "Sample rate: 100 Hz", "Sampling frequency [Hz];100", "Abtastzeit;10;ms", "fs = 100", "Sampling interval (ms);10", "Abtastrate;0,1;kHz"]:
        add(f"rate_{said}", f"Job;7\n{said}\n" + table(t, lambda i: f"{i}", ";", ".", ["Sample"] + head[1:]))
    add("rate_no_times", "Sample rate;100;Hz\n" + "\n".join(line.split(";", 1)[1] for line in table(t, seconds(), ";").splitlines()) + "\n")
    add("no_times", "\n".join(line.split(";", 1)[1] for line in table(t, seconds(), ";").splitlines()) + "\n", ("refused",), "sample_rate_hz")
    add("one_column", "F [N]\n" + "\n".join(f"{f:.2f}" for f in t.force) + "\n", ("refused",), "sample_rate_hz")
    add("rate_tells_unit", "Sample rate;100;Hz\n" + table(t, lambda i: f"{i * 10}", ";", ".", ["t"] + head[1:]))
    # Lines that are no rows.
    plain = table(t, seconds())
    lines = plain.splitlines()
    footers = {
        "eof": ["EOF,,,"],
        "eof_alone": ["EOF"],
        "end": ["# end of file"],
        "summary": ["", "Min,0.00,-0.01,-1.4", "Max,3.50,3.51,211.0", "Mean,1.6,1.5,98"],
        "summary_behind": [",,,", "Minimum:,0.00,-0.01,-1.4"],
        "signature": ["", "Checksum: 3F2A", "Signed: lab"],
        "samples": ["600 rows written,,,"],
    }
    for name, foot in footers.items():
        add(f"foot_{name}", "\n".join(lines + foot) + "\n")
        add(f"foot_{name}_unended", "\n".join(lines + foot))
    add("greeting", "Connected to device v1.2\nOK\n\n" + plain)
    add("greeting_numbers", "v1.2.3,4\n115200,8,N,1\n" + plain)
    add("long_header", "".join(f"# remark {i}: nothing\n" for i in range(260)) + plain)
    for name, unit in [("v", "V,bar,bar,N"), ("right", "s,bar,bar,N"), ("brackets", "[s],[bar],[bar],[N]"), ("label", "unit,bar,bar,N")]:
        add(f"units_{name}", lines[0] + "\n" + unit + "\n" + "\n".join(lines[1:]) + "\n")
    bare = "t,p_set,p_out,F"
    # Names that do not stand above their columns.
    add("names_frame", "\n".join(["p_set [bar],p_out [bar],F [N]"] + lines[1:]) + "\n", ("refused", "left"), "")
    add("names_split", "\n".join(["t [s],p, set [bar],p_out [bar],F [N]"] + lines[1:]) + "\n", ("refused", "left"), "")
    add("names_spaced", "\n".join(["t [s] p_set [bar] p_out [bar] F [N]"] + [line.replace(",", " ") for line in lines[1:]]) + "\n", ("refused", "left"), "")
    add("names_comment", "\n".join([lines[0] + ",Comment"] + lines[1:]) + "\n")
    stamps_apart = [f"2024-01-18 09:10:{i // 100:02d}.{i % 100:02d} " + line.split(",", 1)[1].replace(",", " ") for i, line in enumerate(lines[1:])]
    add("names_stamp_spaced", "\n".join(["Time p_set_bar p_out_bar F_N"] + stamps_apart) + "\n", ("refused", "left"), "")
    add("first_empty", "\n".join("," + line for line in lines) + "\n")
    add("last_empty", "\n".join(line + "," for line in lines) + "\n")
    add("last_empty_rows", "\n".join([lines[0]] + [line + "," for line in lines[1:]]) + "\n")
    add("frame_index", "\n".join(["," + lines[0]] + [f"{i}," + line for i, line in enumerate(lines[1:])]) + "\n")
    add("sep_line", "sep=,\n" + plain)
    add("blank_rows", plain + ",,,\n,,,\n")
    add("exponents", "\n".join([lines[0]] + [",".join(f"{float(cell):.6E}" for cell in line.split(",")) for line in lines[1:]]) + "\n")
    add("fortran", "\n".join([lines[0]] + [",".join(f"{float(cell):.6E}".replace("E", "D") for cell in line.split(",")) for line in lines[1:]]) + "\n", ("refused", "left"), "")
    add("comments_among", "\n".join(part for i, line in enumerate(lines) for part in ([line, f"# mark {i}"] if i and i % 100 == 0 else [line])) + "\n")
    add("rate_decimated", "Sample rate;1000;Hz\n" + table(t, lambda i: f"{i * 10}", ";", ".", ["Sample"] + head[1:]), ("refused",), "")
    add("rate_thousand", "Sample rate;1.000;Hz\n" + table(t, lambda i: f"{i}", ";", ".", ["Sample"] + head[1:]), ("refused",), "")
    add("rate_other", "Sample rate;250;Hz\n" + table(t, lambda i: f"{i * 10}", ";", ".", ["t"] + head[1:]), ("refused",), "")
    add("force_in_g", table(t, seconds(), ";", ".", head[:3] + ["Kraft [g]"]), ("left",), "Kraft")
    by_id = [f"{clock('%Y-%m-%d %H:%M:%S')(i)};{k};{values[i]:.4f}" for i in range(ROWS) for k, values in enumerate((t.p_set, t.p_out, t.force))]
    add("columns_by_id", "\n".join(["Time;Channel;Value"] + by_id) + "\n", ("refused",), "")
    noon = lambda i: f"{12 if i < 200 else 1:02d}:{59 if i < 200 else 0:02d}:{(58 + i // 100) % 60:02d}.{i % 100:02d}"
    add("half_day", table(t, noon, ";", ".", stamped), ("refused",), "")
    add("midnight", table(t, lambda i: (datetime.datetime(2024, 1, 18, 23, 59, 58) + datetime.timedelta(milliseconds=10 * i)).strftime("%H:%M:%S.%f"), ";", ".", stamped))
    add("units_apart", bare + "\ns,bar,bar,N\n" + "\n".join(lines[1:]) + "\n")
    add("units_kpa", bare + "\nms,kPa,kPa,kN\n" + "\n".join(table(t, lambda i: f"{i * 10}", ",", ".", [], digits=(1, 2, 5), scale=(100, 100, 1e-3)).splitlines()) + "\n")
    add("units_unknown", bare + "\ns,bar,bar,ozf\n" + "\n".join(lines[1:]) + "\n", ("refused",), "ozf")
    for at_row in (200, 301):
        add(f"header_again_{at_row}", "\n".join(lines[:at_row] + [lines[0]] + lines[at_row:]) + "\n")
        add(f"page_break_{at_row}", "\n".join(lines[:at_row] + ["", "--- page 2 ---", lines[0]] + lines[at_row:]) + "\n")
        add(f"warning_{at_row}", "\n".join(lines[:at_row] + ["WARNING: buffer overrun"] + lines[at_row:]) + "\n")
    again = lines[1:301] + [lines[0]] + [f"{0.01 * i:.2f}," + line.split(",", 1)[1] for i, line in enumerate(lines[301:])]
    half = Truth(seed, ROWS)
    half.time, half.p_set, half.p_out, half.force = ([*v[:300]] for v in (half.time, half.p_set, half.p_out, half.force))
    add("begins_anew", "\n".join([lines[0]] + again) + "\n", ("read", "refused"), "", truth=half)
    without = lines[1:301] + [f"{0.01 * i:.2f}," + line.split(",", 1)[1] for i, line in enumerate(lines[301:])]
    add("falls_back", "\n".join([lines[0]] + without) + "\n", ("refused",), "go back")
    add("torn", plain[:-9], ("refused",), "cut off")
    # Marks of missing values.
    for mark in ["OVER", "#DIV/0!", "#WERT!", "---", "n/a", "NaN", "ERR", "Overflow", "<MIN>", "null", "-1.#IND", "Bad", "*****", "inf"]:
        holed = [line if i not in (200, 201, 350) else line.rsplit(",", 1)[0] + "," + mark for i, line in enumerate(lines)]
        gone = Truth(seed)
        for i in (200, 201, 350):
            gone.force[i - 1] = math.nan
        add(f"missing_{mark}", "\n".join(holed) + "\n", truth=gone)
    for mark in ["-9999", "9999", "-999.25", "1e30", "99999.9", "-32768", "6553.5"]:
        holed = [line if i not in (200, 201, 350) else line.rsplit(",", 1)[0] + "," + mark for i, line in enumerate(lines)]
        add(f"sentinel_{mark}", "\n".join(holed) + "\n", ("doubt",), "far from", truth=gone)
    # Several clocks.
    shifted = [f"{0.01 * i:.3f},{t.force[i]:.3f},{0.01 * i:.3f},{t.p_out[i]:.4f}" for i in range(ROWS)]
    add("clocks_same", "\n".join(["t_F [s],F [N],t_p [s],p_out [bar]"] + shifted) + "\n", tolerance={"skip": "p_set"})
    for labels in ["t_F [s],F [N],t_p [s],p_out [bar]", "t1 [s],F [N],t2 [s],p_out [bar]", "Time,F [N],Time,p_out [bar]", "Time,F [N],Time.1,p_out [bar]", "X_Value,F [N],X_Value,p_out [bar]"]:
        ahead = [f"{0.01 * i:.2f},{t.force[i]:.3f},{0.01 * (i + 50):.2f},{t.p_out[i + 50]:.4f}" for i in range(ROWS - 50)]
        add(f"clocks_{labels}", "\n".join([labels] + ahead) + "\n", tolerance={"skip": "p_set", "rows": ROWS - 50})
    ahead = [f"{0.01 * i:.2f},{t.force[i]:.3f},{0.01 * (i + 50):.2f},{t.p_out[i + 50]:.4f}" for i in range(ROWS - 50)]
    add("clocks_uptime", "\n".join(["t [s],F [N],uptime [s],p_out [bar]"] + ahead) + "\n", ("refused",), "clock")
    front = [f"{0.01 * i:.2f},{0.01 * (i + 50):.2f},{t.force[i]:.3f},{t.p_out[i + 50]:.4f}" for i in range(ROWS - 50)]
    add("clocks_in_front", "\n".join(["t_F [s],t_p [s],F [N],p_out [bar]"] + front) + "\n", ("refused",), "clock")
    slower = [f"{0.01 * i:.2f};{t.force[i]:.3f};" + (f"{0.05 * i:.2f};{t.p_out[5 * i]:.4f}" if i < ROWS // 5 else ";") for i in range(ROWS)]
    add("clocks_slower", "\n".join(["Time [s];F [N];Time [s];p_out [bar]"] + slower) + "\n", tolerance={"skip": "p_set", "grid": 5})
    add("clocks_ragged", "\n".join(["Time [s];F [N];Time [s];p_out [bar]"] + [line.rstrip(";") for line in slower]) + "\n", tolerance={"skip": "p_set", "grid": 5})
    add("clocks_ragged_eof", "\n".join(["Time [s];F [N];Time [s];p_out [bar]"] + [line.rstrip(";") for line in slower] + ["EOF"]) + "\n", tolerance={"skip": "p_set", "grid": 5})
    # A row for each variable.
    def long(times, mark=".", value="Value", extra=""):
        rows = []
        for i in range(ROWS):
            for name, values, digits in [("p_set_bar", t.p_set, 2), ("p_out_bar", t.p_out, 4), ("Force_N", t.force, 3)]:
                rows.append(f"{times(i)};{name};{number(values[i], digits, mark)}{extra}")
        return "\n".join([f"Time;VarName;{value}" + (";Quality" if extra else "")] + rows) + "\n"

    add("long_iso", long(clock("%Y-%m-%d %H:%M:%S")))
    add("long_comma", long(clock("%d.%m.%Y %H:%M:%S"), ",", "Wert"))
    add("long_quality", long(clock("%Y-%m-%d %H:%M:%S"), ".", "Value", ";1"))
    add("long_coarse", long(clock("%Y-%m-%d %H:%M:%S", -1)), ("refused",), "sample_rate_hz")
    blocks = [line for name in ("p_set_bar", "p_out_bar", "Force_N") for line in long(clock("%Y-%m-%d %H:%M:%S")).splitlines()[1:] if f";{name};" in line]
    add("long_blocks", "\n".join(["Time;VarName;Value"] + blocks) + "\n")
    # Units.
    for unit, factor, digits, may, reason in [("[kN]", 1e-3, 5, ("read",), ""), ("[daN]", 0.1, 3, ("read",), ""), ("[Newton]", 1, 2, ("read",), ""), ("[kp]", 1 / 9.80665, 4, ("read",), ""),
                                              ("[mA]", 0.05, 4, ("left",), "F"), ("[V]", 0.04, 4, ("left",), "F"), ("[ozf]", 3.5969, 3, ("refused",), "ozf"), ("[MN]", 1e-6, 9, ("refused",), "MN")]:
        add(f"force_{unit}", table(t, seconds(), ";", ".", head[:3] + [f"F {unit}"], digits=(2, 4, digits), scale=(1, 1, factor)), may, reason)
    for unit, factor in [("[BAR]", 1), ("[kpa]", 100), ("[PSI]", 14.503773773), ("[barg]", 1), ("[mbar]", 1000), ("[kPag]", 100)]:
        add(f"pressure_{unit}", table(t, seconds(), ";", ".", ["t [s]", f"p_set {unit}", f"p_out {unit}", "F [N]"], digits=(5, 6, 2), scale=(factor, factor, 1)))
    vectors = [f"{t.time[i]:.2f};[0.1, 0.2, {t.force[i]:.2f}]" for i in range(ROWS)]
    add("vectors", "\n".join(["t [s];force [N]"] + vectors) + "\n", ("left",), "force", tolerance={"has": ["force"]})
    stacked = [f"{t.time[i]:.2f};0.1 0.2 {t.force[i]:.2f}" for i in range(ROWS)]
    add("vectors_spaces", "\n".join(["t [s];force [N]"] + stacked) + "\n", ("left",), "force", tolerance={"has": ["force"]})
    add("unit_in_cells", "\n".join(["t [s];F"] + [f"{t.time[i]:.2f};{t.force[i]:.2f} N" for i in range(ROWS)]) + "\n", ("left", "refused"), "F")
    return found


QUANTITIES = {"p_set": ("set_pressure_gauge", 1e5), "p_out": ("measured_regulator_pressure_gauge", 1e5), "force": ("measured_force", 1.0)}


def run(program, *arguments, folder):
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


def judge(program, log, folder):
    """One of read, refused, doubt, left, silent, broken; and what was said."""
    name = "log." + log.ending
    data = log.text if isinstance(log.text, bytes) else log.text.encode()
    with open(os.path.join(folder, name), "wb") as file:
        file.write(data)
    code, out, err = run(program, "new", "import", "map.toml", "--from", name, "--force", folder=folder)
    if code != 0:
        return ("refused" if code == 2 else "broken"), err + out
    draft = open(os.path.join(folder, "map.toml"), encoding="utf-8").read()
    asked = [line for line in out.splitlines() if line.startswith("asked")]
    code, out, err = run(program, "import", "map.toml", name, "--out", "out.parquet", "--force", folder=folder)
    if code != 0:
        return ("refused" if code == 2 else "broken"), err + "\n".join(asked)
    _, report, _ = run(program, "import", "map.toml", name, "--json", folder=folder)
    doubts = [doubt for channel in json.loads(report)["recordings"][0]["channels"] for doubt in channel["doubts"]]
    wrong = compare(program, log, folder)
    if doubts:
        return "doubt", "\n".join(doubts)
    if not wrong:
        return "read", ""
    # A quantity that is absent is no wrong one, if the draft says what its column holds.
    if all(text.startswith("absent") for text in wrong) and "# Not used" in draft:
        return "left", draft.split("# Not used", 1)[1]
    return "silent", "; ".join(wrong)[:300] + "\n" + "\n".join(asked)


def compare(program, log, folder):
    rows = read_parquet(os.path.join(folder, "out.parquet"))
    truth, tolerance, wrong = log.truth, log.tolerance, []
    time = rows["time_s"]
    wanted = tolerance.get("rows", len(truth.time))
    if len(time) != wanted:
        wrong.append(f"{len(time)} rows of {wanted}")
    near = max((abs(time[i] - time[0] - truth.time[i]) for i in range(min(len(time), wanted))), default=1)
    if near > tolerance.get("t", 1e-6):
        wrong.append(f"times off by {near:.3g} s")
    for name, (quantity, factor) in QUANTITIES.items():
        right = getattr(truth, name)
        if tolerance.get("skip") == name:
            continue
        column = next((key for key in rows if key.startswith(quantity + "_")), None)
        if column is None:
            if name in tolerance.get("has", QUANTITIES):
                wrong.append(f"absent: {name}")
            continue
        digit = {"p_set": 0.006e5, "p_out": 0.00006e5, "force": 0.006}[name]
        digit = max(digit, tolerance.get("p", 0) if name != "force" else 0)
        for i, value in enumerate(rows[column][:wanted]):
            if tolerance.get("grid") and i % tolerance["grid"]:
                continue
            if tolerance.get("rows") and math.isnan(value):
                continue
            same = math.isnan(value) and math.isnan(right[i])
            if not same and not abs(value - factor * right[i]) <= digit * 1.02 + 1e-6 * abs(value):
                wrong.append(f"{name}, row {i}: {value} for {factor * right[i]}")
                break
    return wrong


def read_parquet(path):
    import pyarrow.parquet

    read = pyarrow.parquet.read_table(path).to_pydict()
    return {key: [math.nan if value is None else value for value in values] for key, values in read.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep")
    parser.add_argument("--only")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    tally, faults = {}, []
    every = logs(arguments.seed)
    with tempfile.TemporaryDirectory() as folder:
        for number_of, log in enumerate(every):
            if arguments.only and arguments.only not in log.name:
                continue
            own = os.path.join(arguments.keep or folder, f"{number_of:03d}")
            os.makedirs(own, exist_ok=True)
            verdict, said = judge(program, log, own)
            tally[verdict] = tally.get(verdict, 0) + 1
            fine = verdict in log.may and (log.reason in said or verdict == "read")
            # To ask where there is one reading is a nuisance, and no error.
            if not fine:
                faults.append((log, verdict, said))
    count = sum(tally.values())
    for log, verdict, said in faults:
        print(f"{log.name}: {verdict}, expected {' or '.join(log.may)} {log.reason!r}\n    " + said.strip().replace("\n", "\n    ")[:700])
    print(f"{count} dialects: " + ", ".join(f"{value} {key}" for key, value in sorted(tally.items())))
    print(f"as expected: {count - len(faults)} of {count}; misread in silence: {tally.get('silent', 0)}; broken: {tally.get('broken', 0)}")
    sys.exit(1 if tally.get("silent", 0) or tally.get("broken", 0) else 0)


if __name__ == "__main__":
    main()
