#!/usr/bin/env python3
"""Valid small files of every kind that the program reads, spoilt at random, and the program run on each: what it answers, how long and with how much memory.

    python3 tests/studies/mutated_files.py [--count 3000] [--seed 1] [--jobs 2] [--out runs/mutated] [--only KIND] [--again NUMBER] IDC

Each file gets one to four faults: bits turned, bytes and numbers set to extremes, lengths made long, parts cut off, doubled, taken out or taken from another
file of its kind. Every answer must be one of the exit codes 0 to 3 and 130, within 10 s and 1 GB, without a panic, and without anything half written: of a
refusal nothing at all. The list of what was done stands in OUT/cases.csv; the same command goes on where it was stopped. The table is printed, and stands in
OUT/table.md; files that were answered wrongly are kept in OUT/faults. `--again` makes the file of one number and says the command. Without packages;
`zstd` and the program make some of the files.
"""

import argparse
import csv
import gzip
import io
import os
import random
import re
import shutil
import signal
import sqlite3
import struct
import subprocess
import sys
import tempfile
import threading
import time
import zipfile
import zlib
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
CODES = {0, 1, 2, 3, 130}
SECONDS, MEGABYTES = 10.0, 1000.0
# Bytes of a spoilt file, at most: this program's own memory counts as the least of what it starts.
LARGEST = 1 << 20
HEAD = ["number", "kind", "faults", "code", "seconds", "megabytes", "wrong"]


# Files made here ----------------------------------------------------------------------------------------------------------------------------------

def text(value):
    value = value if isinstance(value, bytes) else value.encode()
    return struct.pack("<I", len(value)) + value


def mcap(chunks):
    """Two topics, 40 messages each; chunks plain, by zstd, or none."""
    def record(kind, body):
        return bytes([kind]) + struct.pack("<Q", len(body)) + body

    rule = "\n" + "=" * 80 + "\nMSG: "
    header = rule + "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id" + rule + "builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    joints = "std_msgs/Header header\nstring[] name\nfloat64[] position" + header
    wrench = (
        "std_msgs/Header header\ngeometry_msgs/Wrench wrench" + header + rule + "geometry_msgs/Wrench\nVector3 force\nVector3 torque"
        + rule + "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
    )
    body = b""
    for number, (topic, name, words) in enumerate([("/joint_states", "sensor_msgs/msg/JointState", joints), ("/wrench", "geometry_msgs/msg/WrenchStamped", wrench)]):
        body += record(3, struct.pack("<H", number + 1) + text(name) + text("ros2msg") + text(words))
        body += record(4, struct.pack("<HH", number, number + 1) + text(topic) + text("cdr") + struct.pack("<I", 0))

    def start(row):
        return b"\0\1\0\0" + struct.pack("<iI", 1_700_000_000, row * 10_000_000) + text(b"a\0") + bytes(2)

    for row in range(40):
        when = 1_700_000_000_000_000_000 + row * 10_000_000
        state = start(row) + struct.pack("<I", 1) + text(b"slide\0") + bytes(2) + struct.pack("<I", 1) + bytes(4) + struct.pack("<d", 0.01 + 1e-4 * row)
        force = start(row) + bytes(4) + struct.pack("<6d", 0, 0, 40 + row % 7, 0, 0, 0)
        for channel, data in enumerate([state, force]):
            body += record(5, struct.pack("<HIQQ", channel, row, when, when) + data)
    if chunks == "records":
        return body
    if chunks is not None:
        return mcap_of(chunks, body)
    return mcap_of(None, body)


def mcap_of(chunks, body):
    """Records as a file: as they are, in a chunk, or in one that is packed."""
    def record(kind, body):
        return bytes([kind]) + struct.pack("<Q", len(body)) + body

    if chunks is not None:
        packed = body if chunks == "" else subprocess.run(["zstd", "-q", "-c"], input=body, stdout=subprocess.PIPE, check=True).stdout
        body = record(6, struct.pack("<QQQI", 0, 1 << 62, len(body), zlib.crc32(body)) + text(chunks) + struct.pack("<Q", len(packed)) + packed)
    magic = b"\x89MCAP0\r\n"
    return magic + record(1, text("ros2") + text("")) + body + record(15, bytes(4)) + record(2, bytes(20)) + magic


def bag():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "a.db3")
        base = sqlite3.connect(path)
        base.executescript(
            "PRAGMA page_size=512;"
            "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT,type TEXT,serialization_format TEXT,offered_qos_profiles TEXT);"
            "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER,timestamp INTEGER,data BLOB);"
            "CREATE INDEX stamps ON messages(timestamp);"
            "INSERT INTO topics VALUES(1,'/force','std_msgs/msg/Float64','cdr','');"
        )
        rows = [(row + 1, 1, 10_000_000 * row, b"\0\1\0\0" + struct.pack("<d", 40 + row % 5)) for row in range(60)]
        base.executemany("INSERT INTO messages VALUES(?,?,?,?)", rows)
        base.commit()
        base.close()
        return Path(path).read_bytes()


def mat_of(elements):
    """Elements, each packed, as a file."""
    return b"MATLAB 5.0 MAT-file".ljust(116) + bytes(8) + struct.pack("<H", 256) + b"IM" + b"".join(struct.pack("<II", 15, len(own)) + own for own in map(zlib.compress, elements))


def mat(packed):
    def array(name, values):
        body = struct.pack("<IIII", 6, 8, 6, 0) + struct.pack("<IIii", 5, 8, len(values), 1) + struct.pack("<II", 1, len(name)) + name + bytes(-len(name) % 8)
        body += struct.pack("<II", 9, 8 * len(values)) + struct.pack(f"<{len(values)}d", *values)
        element = struct.pack("<II", 14, len(body)) + body
        if not packed:
            return element
        small = zlib.compress(element)
        return struct.pack("<II", 15, len(small)) + small

    columns = [(b"t", [0.01 * k for k in range(50)]), (b"F", [40 + k % 7 for k in range(50)])]
    return b"MATLAB 5.0 MAT-file".ljust(116) + bytes(8) + struct.pack("<H", 256) + b"IM" + b"".join(array(*column) for column in columns)


def tdms():
    def entry(name, values):
        return text(f"/'g'/'{name}'") + struct.pack("<IIIQ", 20, 10, 1, values) + struct.pack("<I", 2) + text("wf_increment") + struct.pack("<Id", 10, 0.01) + text("unit_string") + struct.pack("<I", 0x20) + text("N")

    meta = struct.pack("<I", 2) + entry("F", 30) + entry("p", 30)
    raw = struct.pack("<60d", *[40 + k % 7 for k in range(60)])
    first = b"TDSm" + struct.pack("<IIQQ", 0xE, 4713, len(meta) + len(raw), len(meta)) + meta + raw
    return first + b"TDSm" + struct.pack("<IIQQ", 8, 4713, len(raw), 0) + raw


def table(mark=",", decimal="."):
    rows = [f"{0.01 * k:.3f}{mark}{40 + 0.5 * (k % 9):.2f}{mark}{0.01 + 1e-4 * k:.5f}".replace(".", decimal) for k in range(60)]
    return ("\n".join([mark.join(["t [s]", "F [N]", "stroke [m]"])] + rows) + "\n").encode()


def archive(members):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as own:
        for name, content in members:
            own.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_STORED if name == "mimetype" else zipfile.ZIP_DEFLATED)
    return file.getvalue()


def xlsx(sheet=None):
    space = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    relations = 'xmlns="http://schemas.openxmlformats.org/package/2006/relationships"'
    head = '<row r="1"><c r="A1" t="inlineStr"><is><t>t [s]</t></is></c><c r="B1" t="s"><v>0</v></c></row>'
    rows = "".join(f'<row r="{k + 2}"><c r="A{k + 2}"><v>{0.01 * k}</v></c><c r="B{k + 2}"><v>{40 + k % 7}</v></c></row>' for k in range(40))
    own = f"<worksheet {space}><sheetData>{head}{rows}</sheetData></worksheet>".encode()
    if sheet is None:
        return own
    return archive([
        ("[Content_Types].xml", '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="xml" ContentType="application/xml"/></Types>'),
        ("_rels/.rels", f'<Relationships {relations}><Relationship Id="r1" Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>'),
        ("xl/workbook.xml", f'<workbook {space} xmlns:r="{office}"><sheets><sheet name="S" sheetId="1" r:id="r1"/></sheets></workbook>'),
        ("xl/_rels/workbook.xml.rels", f'<Relationships {relations}><Relationship Id="r1" Type="{office}/worksheet" Target="worksheets/sheet1.xml"/><Relationship Id="r2" Type="{office}/sharedStrings" Target="sharedStrings.xml"/></Relationships>'),
        ("xl/sharedStrings.xml", f"<sst {space}><si><t>F [N]</t></si></sst>"),
        ("xl/worksheets/sheet1.xml", sheet),
    ])


def ods(content=None):
    name = "urn:oasis:names:tc:opendocument:xmlns:"
    cell = '<table:table-cell office:value-type="float" office:value="{0}"><text:p>{0}</text:p></table:table-cell>'
    rows = "".join(f"<table:table-row>{cell.format(0.01 * k)}{cell.format(40 + k % 7)}</table:table-row>" for k in range(40))
    sheet = f'<office:document-content xmlns:office="{name}office:1.0" xmlns:table="{name}table:1.0" xmlns:text="{name}text:1.0"><office:body><office:spreadsheet><table:table table:name="S">{rows}</table:table></office:spreadsheet></office:body></office:document-content>'
    if content is None:
        return sheet.encode()
    return archive([("mimetype", "application/vnd.oasis.opendocument.spreadsheet"), ("META-INF/manifest.xml", f'<manifest:manifest xmlns:manifest="{name}manifest:1.0"/>'), ("content.xml", content)])


def box(form):
    corners = [(x, y, z) for x in (0.0, 40.0) for y in (0.0, 30.0) for z in (0.0, 10.0)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    if form == "stl":
        return bytes(80) + struct.pack("<I", len(faces)) + b"".join(struct.pack("<12fH", 0, 0, 0, *[x for i in face for x in corners[i]], 0) for face in faces)
    if form == "stl_text":
        loops = ["facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % corners[i] for i in face) + "endloop\nendfacet\n" for face in faces]
        return ("solid box\n" + "".join(loops) + "endsolid box\n").encode()
    if form == "obj":
        return ("".join("v %g %g %g\n" % corner for corner in corners) + "".join("f %d %d %d\n" % tuple(i + 1 for i in face) for face in faces)).encode()
    if form == "ply":
        head = f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\nproperty float x\nproperty float y\nproperty float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        return (head + "".join("%g %g %g\n" % corner for corner in corners) + "".join("3 %d %d %d\n" % face for face in faces)).encode()
    numbers = " ".join("%g" % x for corner in corners for x in corner)
    places = " ".join(str(i) for face in faces for i in face)
    return (
        '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="0.001"/><up_axis>Z_UP</up_axis></asset>'
        f'<library_geometries><geometry id="g"><mesh><source id="s"><float_array id="a" count="{3 * len(corners)}">{numbers}</float_array><technique_common><accessor source="#a" count="{len(corners)}" stride="3">'
        '<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#s"/></vertices>'
        f'<triangles count="{len(faces)}"><input semantic="VERTEX" source="#v" offset="0"/><p>{places}</p></triangles></mesh></geometry></library_geometries>'
        '<library_visual_scenes><visual_scene id="w"><node><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>'
        '<scene><instance_visual_scene url="#w"/></scene></COLLADA>'
    ).encode()


def urdf():
    link = '<link name="l{0}"><inertial><mass value="2"/><origin xyz="0 0 0.1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>'
    joint = '<joint name="j{0}" type="revolute"><parent link="l{1}"/><child link="l{0}"/><origin xyz="0 0 0.2" rpy="0 0 0"/><axis xyz="{2}"/><limit lower="-3" upper="3" effort="100" velocity="3"/></joint>'
    links = "".join(link.format(k) for k in range(7))
    joints = "".join(joint.format(k, k - 1, "0 0 1" if k % 2 else "0 1 0") for k in range(1, 7))
    return f'<?xml version="1.0"?><robot name="a">{links}{joints}</robot>'.encode()


MAPS = {
    "bag": '[[file]]\nform = "bag"\ntime = { column = "header.stamp" }\n[[file.channel]]\nquantity = "measured_stroke"\ncolumn = "/joint_states.position"\njoint = "slide"\nunit = "m"\n[[file.channel]]\nquantity = "measured_force"\ncolumn = "/wrench.wrench.force.z"\nunit = "N"\n',
    "db3": '[[file]]\nform = "bag"\n[[file.channel]]\nquantity = "measured_force"\ncolumn = "/force.data"\nunit = "N"\n',
    "mat": '[[file]]\nform = "mat5"\ntime = { column = "t", unit = "s" }\n[[file.channel]]\nquantity = "measured_force"\ncolumn = "F"\nunit = "N"\n',
    "tdms": '[[file]]\nform = "tdms"\n[[file.channel]]\nquantity = "measured_force"\ncolumn = "g/F"\nunit = "N"\n',
    "parquet": '[[file]]\nform = "parquet"\ntime = { column = "time_s", unit = "s" }\n[[file.channel]]\nquantity = "measured_force"\ncolumn = "measured_force_n"\nunit = "N"\n',
    "csv": '[[file]]\nform = "text"\nheader_lines = 1\nnames_line = 1\ntime = { column = 1, unit = "s" }\n[[file.channel]]\nquantity = "measured_force"\ncolumn = 2\nunit = "N"\n',
    "xlsx": '[[file]]\nform = "spreadsheet"\nheader_lines = 1\ntime = { column = 1, unit = "s" }\n[[file.channel]]\nquantity = "measured_force"\ncolumn = 2\nunit = "N"\n',
    "ods": '[[file]]\nform = "spreadsheet"\ntime = { column = 1, unit = "s" }\n[[file.channel]]\nquantity = "measured_force"\ncolumn = 2\nunit = "N"\n',
}


class Seeds:
    """Valid files of each kind, the name that they have, and the commands that read them: `{file}`, `{out}`, `{near}` (a folder of its own)."""

    def __init__(self, idc, folder):
        self.idc, self.folder = idc, folder
        self.kinds = {}
        self.log("bag", "a.mcap", [mcap(None), mcap(""), *([mcap("zstd")] if shutil.which("zstd") else [])])
        self.log("db3", "a.db3", [bag()])
        self.log("mat", "a.mat", [mat(False), mat(True)])
        self.log("tdms", "a.tdms", [tdms()])
        self.log("csv", "a.csv", [table(), table(";", ","), table("\t"), gzip.compress(table(), mtime=0)])
        self.log("xlsx", "a.xlsx", [xlsx(xlsx())])
        self.log("ods", "a.ods", [ods(ods())])
        # Spoilt before they are packed, so that no check sum keeps them out.
        self.log("xlsx", "a.xlsx", [xlsx()], "sheet of xlsx", xlsx)
        self.log("ods", "a.ods", [ods()], "content of ods", ods)
        arrays = mat(False)[128:]
        first = 8 + struct.unpack("<I", arrays[4:8])[0]
        self.log("mat", "a.mat", [arrays[first:]], "array of mat", lambda data: mat_of([arrays[:first], data]))
        self.log("bag", "a.mcap", [mcap("records")], "chunk of bag", lambda data: mcap_of("", data))
        self.log("csv", "a.csv.gz", [table()], "packed csv", lambda data: gzip.compress(data, mtime=0))
        for form, name in [("stl", "a.stl"), ("stl_text", "a.stl"), ("obj", "a.obj"), ("ply", "a.ply"), ("dae", "a.dae")]:
            self.add(form, name, [box(form)], [["edges", "{file}", "--unit", "m" if form == "dae" else "mm"]])
        self.add("urdf", "a.urdf", [urdf()], [["new", "arm", "--urdf", "{file}", "{out}.toml"]])
        self.add("map", "a.toml", [self.map("csv")], [["import", "{file}", self.put("map.csv", table()), "--out", "{out}.csv"]])
        self.made_by_the_program()

    def put(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
        return str(path)

    def map(self, kind):
        return ('schema = 1\ntitle = "A test"\n' + MAPS[kind]).encode()

    def add(self, kind, name, files, commands, near=None, packing=None):
        self.kinds[kind] = (name, files, commands, near, packing or (lambda data: data))

    def log(self, kind, name, files, called=None, packing=None):
        own = self.put(f"map_{kind}.toml", self.map(kind))
        self.add(called or kind, name, files, [["import", own, "{file}", "--out", "{out}.csv"], ["new", "import", "--from", "{file}", "{out}.toml"]], packing=packing)

    def run(self, *arguments):
        subprocess.run([self.idc, *arguments], check=True, stdout=subprocess.DEVNULL, cwd=self.folder)

    def made_by_the_program(self):
        """Scenarios and models of the project, a rig file, recordings, tables and results."""
        models = [path for path in (PROJECT / "models").rglob("*") if path.is_file()] + list((PROJECT / "assets").glob("*.stl"))
        near = self.folder / "project"
        for path in models + [path for path in (PROJECT / "scenarios").rglob("*.toml")]:
            own = near / path.relative_to(PROJECT)
            own.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, own)
        # Of this one the job cannot be done.
        scenarios = [path.read_bytes() for path in sorted((near / "scenarios").glob("*.toml")) if path.stem != "weak_supply"]
        self.add("scenario", "project/scenarios/mutated_{number}.toml", scenarios, [["check", "{file}"]], "project")
        self.run("run", "project/scenarios/paper_step.toml", "--out", "made", "--force")
        samples = self.folder / "made" / "samples.parquet"
        summary = self.folder / "made" / "summary.json"
        self.run("new", "rig", "rig/rig.toml", "--force")
        self.put("own_arm/arm.urdf", urdf())
        self.run("new", "arm", "--urdf", "own_arm/arm.urdf", "own_arm/arm.toml", "--force")
        self.run("import", self.put("map_own.toml", self.map("csv")), self.put("own.csv", table()), "--out", "own.parquet", "--force")
        self.log("parquet", "a.parquet", [(self.folder / "own.parquet").read_bytes(), samples.read_bytes()])
        self.add("recording", "samples.parquet", [samples.read_bytes()], [["report", "{folder}"]], "made")
        self.add("result", "summary.json", [summary.read_bytes()], [["report", "{folder}"], ["compare", "{folder}", str(self.folder / "made"), "--out", "{out}"]], "made")
        self.add("rig", "rig.toml", [(self.folder / "rig" / "rig.toml").read_bytes()], [["check", "{file}"]])
        self.add("arm", "arm.toml", [(self.folder / "own_arm" / "arm.toml").read_bytes()], [["check", "{file}"]], "own_arm")
        points = b"simulation.step_ms,load.stiffness_n_per_m\n0.5,30000\n1.0,40000\n"
        scenario = str(near / "scenarios" / "paper_step.toml")
        self.add("points", "points.csv", [points], [["vary", scenario, "--points", "{file}", "--out", "{out}", "--plan"]])
        law = (near / "scenarios" / "paper_step.toml").read_bytes() + b'\n[[effect]]\nname = "a_law"\nacts_on = "piston_force"\nis = "-c * max(v, 0) + k * x * tanh(v / w)^2"\nc = { value = 200, unit = "N s/m" }\nk = { value = 30, unit = "N/m" }\nw = { value = 0.01, unit = "m/s" }\n'
        self.add("expression", "project/scenarios/mutated_{number}.toml", [law], [["check", "{file}"]], "project")


# Faults -------------------------------------------------------------------------------------------------------------------------------------------

NUMBERS = [b"0", b"-1", b"1e308", b"-1e308", b"1e-320", b"nan", b"inf", b"-inf", b"99999999999999999999", b"2147483648", b"-0.0", b"", b"1e999", b"0x7f", b"1.5"]
WORDS = [0, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 1 << 30, 100_000_000, (1 << 63) - 1, 1 << 63, (1 << 64) - 1, 1 << 40]


def turned(data, chance):
    for _ in range(chance.choice([1, 1, 2, 8, 64])):
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return "bits"


def word(data, chance):
    size = chance.choice([1, 2, 4, 4, 8])
    at = chance.randrange(len(data))
    order = chance.choice(["little", "little", "big"])
    data[at:at + size] = (chance.choice(WORDS) & ((1 << 8 * size) - 1)).to_bytes(size, order)
    return "number"


def length(data, chance):
    """A whole number that could be a length, made longer or shorter by a little or much."""
    size = chance.choice([2, 4, 8])
    places = [at for at in range(0, max(1, len(data) - size)) if 0 < int.from_bytes(data[at:at + size], "little") <= len(data)]
    if not places:
        return word(data, chance)
    at = chance.choice(places)
    value = int.from_bytes(data[at:at + size], "little")
    other = chance.choice([value + 1, value - 1, value * 2, value + 8, value << 8, len(data), 1 << (8 * size - 2)])
    data[at:at + size] = (other & ((1 << 8 * size) - 1)).to_bytes(size, "little")
    return "length"


def cut(data, chance):
    del data[chance.randrange(len(data)):]
    return "cut"


def doubled(data, chance):
    start, end = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    at = chance.randrange(len(data) + 1)
    data[at:at] = bytes(data[start:end]) * chance.choice([1, 1, 2, 20])
    return "doubled"


def taken_out(data, chance):
    start = chance.randrange(len(data))
    del data[start:start + chance.choice([1, 4, 16, 200])]
    return "taken out"


def written(data, chance):
    """A number of a text set to an extreme."""
    places = list(re.finditer(rb"-?\d+(\.\d+)?(e-?\d+)?", bytes(data)))
    if not places:
        return word(data, chance)
    place = chance.choice(places)
    data[place.start():place.end()] = chance.choice(NUMBERS)
    return "written number"


def lines(data, chance):
    own = bytes(data).split(b"\n")
    first, second = (chance.randrange(len(own)) for _ in range(2))
    own[first], own[second] = (own[second], own[first]) if chance.random() < 0.5 else (own[second], own[second])
    data[:] = b"\n".join(own)
    return "lines"


def spliced(data, other, chance):
    at, start = chance.randrange(len(data)), chance.randrange(len(other))
    data[at:] = other[start:]
    return "spliced"


def mutated(files, seed, number):
    chance = random.Random(f"{seed}/{number}")
    data = bytearray(chance.choice(files))
    is_text = b"\0" not in data[:1000]
    ways = [turned, word, length, cut, doubled, taken_out] + ([written, written, written, lines] if is_text else [length, word])
    said = []
    for _ in range(chance.choice([1, 1, 2, 4])):
        if not data:
            break
        if chance.random() < 0.08:
            said.append(spliced(data, chance.choice(files), chance))
        else:
            said.append(chance.choice(ways)(data, chance))
        del data[LARGEST:]
    return bytes(data), "+".join(said), chance


# Runs ---------------------------------------------------------------------------------------------------------------------------------------------

def watched(command, folder):
    """Exit code (negative by a signal), seconds, megabytes and what was printed; seconds of the processor where others hold it up."""
    began = time.monotonic()
    with open(folder / "printed", "w+b") as printed:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=printed, stderr=printed, cwd=folder)
        late = threading.Timer(6 * SECONDS, process.kill)
        late.start()
        _, status, use = os.wait4(process.pid, 0)
        late.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        printed.seek(0)
        said = printed.read(1 << 20).decode(errors="replace")
    seconds = time.monotonic() - began
    if process.returncode >= 0:
        seconds = min(seconds, use.ru_utime + use.ru_stime)
    return process.returncode, seconds, use.ru_maxrss / 1000, said


def case(seeds, seed, number, only):
    kinds = [only] if only else sorted(seeds.kinds)
    kind = kinds[number % len(kinds)]
    name, files, commands, near, packing = seeds.kinds[kind]
    data, faults, chance = mutated(files, seed, number)
    return kind, name, packing(data), faults, chance.choice(commands), near


def run(seeds, name, data, command, near, number):
    """Runs a command on a file in folders of its own: what `watched` says, the command, and what was left."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        # A file beside the project's own is read there, others in a folder of their own, with what belongs to them.
        file = seeds.folder / name.format(number=number) if near == "project" else folder / "in" / Path(name).name
        if near == "project" or near is None:
            file.parent.mkdir(parents=True, exist_ok=True)
        else:
            shutil.copytree(seeds.folder / near, file.parent)
        file.write_bytes(data)
        out = folder / "out" / "made"
        out.parent.mkdir()
        filled = [part.format(file=file, out=out, folder=file.parent) for part in command]
        answer = watched([seeds.idc, *filled], folder)
        left = [path.name for path in out.parent.iterdir()]
        if near == "project":
            file.unlink()
    return *answer, filled, left


def answered(seeds, seed, number, only, keep):
    kind, name, data, faults, command, near = case(seeds, seed, number, only)
    code, seconds, megabytes, said, filled, left = run(seeds, name, data, command, near, number)
    wrong = []
    if code not in CODES:
        wrong.append(f"exit code {code}")
    if "panicked" in said:
        wrong.append("a panic printed")
    if seconds > SECONDS:
        wrong.append(f"{seconds:.0f} s")
    if megabytes > MEGABYTES:
        wrong.append(f"{megabytes:.0f} MB")
    if code == 2 and left or any(own.startswith(".") for own in left):
        wrong.append(f"left {' '.join(left)}")
    if code != 0 and not said.strip():
        wrong.append("nothing said")
    if wrong:
        keep.mkdir(parents=True, exist_ok=True)
        (keep / f"{number}_{Path(name).name.format(number=number)}").write_bytes(data)
        (keep / f"{number}.txt").write_text(f"{' '.join(filled)}\n{faults}: {', '.join(wrong)}\n\n{said[:4000]}")
    return [number, kind, faults, code, f"{seconds:.2f}", f"{megabytes:.0f}", "; ".join(wrong)]


def check_seeds(seeds):
    """Whether each file is read before it is spoilt: else the program refuses it at its door."""
    unread = []
    for kind, (name, files, commands, near, packing) in sorted(seeds.kinds.items()):
        for place, data in enumerate(files):
            codes = [(run(seeds, name, packing(data), command, near, "valid"), command) for command in commands]
            # A map reads one form of each kind of log; drafts are made of all.
            if kind in MAPS and not any(answer[0] == 0 for answer, _ in codes) or kind not in MAPS and any(answer[0] == 2 or answer[0] < 0 for answer, _ in codes):
                unread.append(f"{kind} {place}: {[(command[0], answer[0], answer[3].strip().splitlines()[:1]) for answer, command in codes]}")
    return unread


def summary(rows):
    """A row a kind: what was answered, and the longest and largest."""
    lines = ["| kind | files | exit code 0 | 1 | 2 | 3 | others | longest [s] | largest [MB] | wrong |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    kinds = sorted({row["kind"] for row in rows})
    for kind in kinds + (["all"] if len(kinds) > 1 else []):
        own = [row for row in rows if kind in ("all", row["kind"])]
        codes = [sum(row["code"] == str(code) for row in own) for code in range(4)]
        longest, largest = (max(float(row[key]) for row in own) for key in ("seconds", "megabytes"))
        wrong = sum(bool(row["wrong"]) for row in own)
        lines.append(f"| {kind} | {len(own)} | {' | '.join(map(str, codes))} | {len(own) - sum(codes)} | {longest:.1f} | {largest:.0f} | {wrong} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("idc")
    parser.add_argument("--count", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path, default=Path("runs/mutated"))
    parser.add_argument("--only")
    parser.add_argument("--again", type=int)
    asked = parser.parse_args()
    out = asked.out.resolve() / f"seed_{asked.seed}{'_' + asked.only if asked.only else ''}"
    out.mkdir(parents=True, exist_ok=True)
    seeds = Seeds(os.path.abspath(asked.idc), Path(tempfile.mkdtemp(prefix="mutated_")))
    if asked.again is not None:
        kind, name, data, faults, command, _ = case(seeds, asked.seed, asked.again, asked.only)
        file = out / f"{asked.again}_{Path(name.format(number=asked.again)).name}"
        file.write_bytes(data)
        print(kind, faults, " ".join(command).replace("{file}", str(file)), sep="\n")
        return 0
    unread = check_seeds(seeds)
    if unread:
        print("valid files are refused:", *unread, sep="\n")
        return 2
    cases = out / "cases.csv"
    rows = []
    if cases.exists():
        with open(cases, newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["wrong"] is not None]
    done = {int(row["number"]) for row in rows}
    todo = iter([number for number in range(asked.count) if number not in done])
    lock, began, stopped = threading.Lock(), time.monotonic(), threading.Event()
    made = 0
    with open(cases, "w", newline="") as file:
        writer = csv.DictWriter(file, HEAD)
        writer.writeheader()
        writer.writerows(rows)

        def work():
            nonlocal made
            while not stopped.is_set():
                with lock:
                    number = next(todo, None)
                if number is None:
                    return
                row = dict(zip(HEAD, map(str, answered(seeds, asked.seed, number, asked.only, out / "faults"))))
                with lock:
                    rows.append(row)
                    writer.writerow(row)
                    file.flush()
                    made += 1
                    if row["wrong"]:
                        print(f"\r{row['number']} {row['kind']} ({row['faults']}): {row['wrong']}", flush=True)
                    if made % 50 == 0:
                        left = (asked.count - len(done) - made) * (time.monotonic() - began) / made
                        print(f"\r{len(done) + made} of {asked.count}, {left / 60:.1f} min left ", end="", file=sys.stderr, flush=True)

        workers = [threading.Thread(target=work) for _ in range(asked.jobs)]
        signal.signal(signal.SIGINT, lambda *_: stopped.set())
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
    shutil.rmtree(seeds.folder)
    table_of = summary(rows)
    (out / "table.md").write_text(table_of)
    print(f"\n{table_of}", end="")
    return 1 if stopped.is_set() or any(row["wrong"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
