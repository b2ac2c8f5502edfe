"""Cam tables in programs and projects of controllers: structures, arrays and XML, by the layouts of their fields."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from struct import pack, unpack
from xml.etree import ElementTree as ET
from xml.sax import SAXParseException, parseString
from xml.sax.handler import ContentHandler
from xml.sax.xmlreader import AttributesImpl

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.laws.catalogue.tables.curve_pieces import (
    NO_UNITS,
    CurvePiece,
    TablePoints,
    TableUnits,
    degree_of,
    of_profile,
    pieces_between,
    powers,
    resolution_of,
)
from optlaws.laws.catalogue.tables.tokens import TextCell, line_of, uncommented


@dataclass(frozen=True)
class FieldLayout:
    """Fields of the structure of a controller, by their contents.

    `fields` says what a field holds and its name: x, y, v, a, j of points; x0, y0, ... and x1, y1, ... of the ends of a
    piece; c0, c1, ... of powers counted from where a piece begins; "type" of what runs after a point, "skip" of
    whether that is ignored.
    """

    name: str
    fields: str
    profiles: Mapping[str, str] | None = None  #: what numbers stand for in the field of the type
    units: TableUnits = NO_UNITS  #: of master and positions, where the structure says them

    @cached_property
    def roles(self) -> dict[str, str]:
        """Meanings of fields by their names in lower case."""
        pairs = (field.split("=") for field in self.fields.split())
        return {name.lower(): role for role, name in pairs}

    @cached_property
    def needed(self) -> frozenset[str]:
        """Names of the fields without which it is another layout."""
        optional = {"v", "a", "j", "j0", "type", "skip"}
        return frozenset(name for name, role in self.roles.items() if role not in optional)


_ENDS = (
    "x0=leadingValueStart x1=leadingValueEnd y0=followingValueStart y1=followingValueEnd v0=geoVeloStart "
    "v1=geoVeloEnd a0=geoAccelStart a1=geoAccelEnd"
)
#: numbers of MC_MotionFunctionType; its names are in the catalogue, apart from those of polynomials
_NC2 = {
    "0": "NOTDEF",
    "1": "POLYNOM1",
    "3": "POLYNOM3",
    "5": "POLYNOM5",
    "7": "POLYNOM7",
    "10": "SINUSLINIE",
    "11": "MODSINUSLINIE",
    "12": "BESTEHORN",
    "13": "BESCHLTRAPEZ",
    "15": "POLYNOM5_MM",
    "24": "POLYNOM7_MM",
}
#: numbers of EMotionFunctionType
_MC3 = {
    "0": "Undefined",
    "1": "Linear",
    "2": "Polynomial3",
    "3": "Polynomial5",
    "4": "Polynomial7",
    "8": "ModifiedSinusoid",
}
#: numbers of LCamHdl_ProfileConstants; the polynomial of all that is given has no name
_LCAMHDL = {"2": "DWELL", "3": "POLYNOM1", "4": "POLYNOM3", "5": "POLYNOM5", "44": ""}

LAYOUTS = (
    FieldLayout("CODESYS SMC_CAMXYVA", "x=dX y=dY v=dV a=dA"),
    FieldLayout(
        "CODESYS Poly7_Coeffs", "x0=x0 x1=x1 c0=a0 c1=a1 c2=a2 c3=a3 c4=a4 c5=a5 c6=a6 c7=a7",
    ),
    FieldLayout(
        "TwinCAT MC_MotionFunctionPoint",
        "x=MasterPos y=SlavePos v=SlaveVelo a=SlaveAcc j=SlaveJerk type=FunctionType skip=PointType",
        _NC2,
    ),
    FieldLayout(
        "TwinCAT MotionFunctionPoint",
        "x=MasterPosition y=SlavePosition v=SlaveVelocity a=SlaveAcceleration j=SlaveJerk type=FunctionType "
        "skip=Ignored",
        _MC3,
    ),
    FieldLayout(
        "Siemens LCamHdl_typeBasicPoint", "x=leadingValue y=followingValue v=velocityRatio a=accelerationRatio",
    ),
    FieldLayout("Siemens LCamHdl elements", f"{_ENDS} j0=geoJerkStart type=camProfileType", _LCAMHDL),
    FieldLayout("Rockwell CAM", "x=Master y=Slave"),
    FieldLayout("B&R MC_CAMPROFILE_TYP", "c0=a c1=b c2=c c3=d c4=e c5=f c6=g x1=x"),
    FieldLayout(
        "ABB MC_PPROFILE", "x=master_position y=interpolation_point v=Velocity_ratio a=Acceleration_ratio",
    ),
    FieldLayout(
        "ROS 2 JointTrajectory", "y=positions v=velocities a=accelerations x=time_from_start", units=TableUnits("s"),
    ),
)  # fmt: skip


#: a field with its value, and the number of the element that it is of where that is beside it
_FIELD = re.compile(r"(?:\[(\d+)\]\s*\.\s*)?\b([A-Za-z_]\w*)\s*:=\s*([^\s,;:()\[\]{}=]+)")
#: how many points a file says that it has
_COUNT = re.compile(r"\b(?:nElements|NoOfRows|PolynomialNumber|NumberOfPoints)\s*:=\s*(\d+)")
_BOUNDS = re.compile(r"\bARRAY\s*\[\s*(\d+)\s*\.\.\s*(\d+)\s*(,[^\]]*)?\]\s*OF", re.IGNORECASE)
_ARRAY = re.compile(r"([^;\n]*?)(?::=|(?<![:=<>])=)\s*(?=\[)")
_INNER = re.compile(r"\[([^\[\]]*)\]")
#: values of a field that is left to the controller
_ABSENT = {"nan", "#ignore", "ignore"}
_YAML = re.compile(r"\b(positions|velocities|accelerations):\s*\[([^\]]*)\]")
_YAML_TIME = re.compile(r"time_from_start:\s*\{\s*sec:\s*(\d+)\s*,\s*nanosec:\s*(\d+)\s*\}")
_CALCULATED = 14  # DINT in an element of CAM_PROFILE
#: a cycle's table has as many points at least: fewer stand for what is laid through them
FEWEST_POINTS = 12
_KINDS_OF_CAM = ("CAM", "CAM_EXTENDED", "CAM_PROFILE")


_Record = dict[str, TextCell]


def decoded(content: str, cam: str | None = None) -> TablePoints | None:
    """Content of a program or a project, of one `cam` of several; None for other files, such as columns of numbers.

    Raises
    ------
    InputError
        If it has the fields of a layout, and a value is missing or wrong; the error names the line.
    """
    if content.lstrip().startswith("<"):
        content = _of_xml(content, cam)
    text = uncommented(content)
    if "joint_names:" in text:
        text = _of_yaml(text, cam)
    fields = [(m[1], m[2].lower(), TextCell(m[3], line_of(text, m.start(2)))) for m in _FIELD.finditer(text)]
    names = {name for _, name, _ in fields}
    layout = max(
        (layout for layout in LAYOUTS if layout.needed <= names),
        key=lambda layout: len(names & layout.roles.keys()),
        default=None,
    )
    if layout is not None:
        records = list(_records(layout, fields))
        if len(records) > 1:
            _check_count(text, len(records))
            skipped = [record.pop("skip", TextCell("", 0)).text.upper() for record in records]
            pairs = zip(records, skipped, strict=True)
            records = [record for record, skip in pairs if not skip.endswith(("IGNORE", "TRUE"))]
        if len(records) > 1:
            return _of_records(layout, records)
    return _of_arrays(text)


class _Tree(ContentHandler):
    """Elements of XML by their names without prefixes, with the lines where they and their texts begin."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[ET.Element] = []
        self.elements: list[ET.Element] = []
        self.lines: dict[ET.Element, int] = {}

    def _here(self) -> int:
        return int(self._locator.getLineNumber())  # type: ignore[attr-defined]  # expat sets it

    def startElement(self, name: str, attrs: AttributesImpl) -> None:
        element = ET.Element(name.rpartition(":")[2], dict(attrs))
        if self.open:
            self.open[-1].append(element)
        self.open.append(element)
        self.elements.append(element)
        self.lines[element] = self._here()

    def characters(self, content: str) -> None:
        element = self.open[-1]
        if not element.text and content.strip():
            self.lines[element] = self._here()
        element.text = (element.text or "") + content

    def endElement(self, name: str) -> None:  # noqa: ARG002 - a name of SAX
        self.open.pop()

    def text(self, part: ET.Element) -> str:
        """The fields in an element and the texts that stand in it, each on its line of the file."""
        lines, index = list[str](), ""
        for element in part.iter():
            if element.tag == "Element":
                index = element.attrib.get("Index", "")
            value, inner = element.attrib.get("Value"), next(iter(element), None)
            shown = ""
            if element.tag == "DataValueMember" and value is not None:
                shown = f"{index}.{element.attrib.get('Name', '')} := {value}"
            elif element.tag == "value" and inner is not None and inner.tag == "simpleValue":
                shown = f"{element.attrib.get('member', '')} := {inner.attrib.get('value', '')}"
            elif element.tag not in {"DataValueMember", "simpleValue"} and (element.text or "").strip():
                shown = str(element.text)
            if shown:
                lines += [""] * (self.lines[element] - len(lines))
                first, *others = shown.split("\n")
                lines[-1] += f"  {first}"
                lines += others
        return "\n".join(lines)


def _of_xml(content: str, cam: str | None) -> str:
    """The fields and the programs in XML as text: of one tag where it is a project with several cams."""
    if "<!ENTITY" in content:
        raise InputError("it is XML with entities of its own, which are not read")
    tree = _Tree()
    try:
        parseString(content.encode(), tree)  # noqa: S317 - it has no entities of its own
    except SAXParseException as error:
        raise InputError(f"it is no XML that can be read: {error.getMessage()}, line {error.getLineNumber()}") from None
    tags = {
        element.attrib.get("Name", ""): element
        for element in tree.elements
        if element.tag in {"Tag", "LocalTag"} and element.attrib.get("DataType") in _KINDS_OF_CAM
    }
    if not tags:
        return tree.text(tree.elements[0])
    if cam is None and len(tags) > 1:
        raise InputError(f"it has several cams, say which: {', '.join(tags)}")
    if cam is not None and cam not in tags:
        raise InputError(f"it has no cam {shortened(cam)}; it has {', '.join(tags)}")
    tag = tags[next(iter(tags)) if cam is None else cam]
    packed = [part for part in tag.iter("Data") if part.attrib.get("Format") == "L5K" and (part.text or "").strip()]
    return "\n" * (tree.lines[packed[0]] - 1) + f"cam := {packed[0].text};" if packed else tree.text(tag)


def _of_yaml(text: str, cam: str | None) -> str:
    """The points of a single joint of a trajectory as fields."""
    joints = [name.strip("\"' ") for name in re.findall(r"^\s*-\s*([\"']?[^\s:\[{]+)\s*$", text, re.MULTILINE)]
    inline = re.search(r"joint_names:\s*\[([^\]]*)\]", text)
    joints = [name.strip("\"' ") for name in inline[1].split(",")] if inline else joints
    if not joints:
        raise InputError("joint_names: it names no joint")
    if cam is None and len(joints) != 1:
        raise InputError(f"it has several joints, say which as the cam: {', '.join(joints)}")
    if cam is not None and cam not in joints:
        raise InputError(f"it has no joint {shortened(cam)}; it has {', '.join(joints)}")
    place = 0 if cam is None else joints.index(cam)

    def of_joint(match: re.Match[str]) -> str:
        cells = match[2].split(",")
        if len(cells) != len(joints):
            raise InputError(
                f"line {line_of(text, match.start())}: {len(cells)} {match[1]} of {len(joints)} joints: mend it"
            )
        return f"{match[1]} := {cells[place].strip()}"

    # digits of the seconds and of the nanoseconds, so that none is lost
    return _YAML_TIME.sub(lambda m: f"time_from_start := {int(m[1])}.{int(m[2]):09d}", _YAML.sub(of_joint, text))


def _records(layout: FieldLayout, fields: Sequence[tuple[str | None, str, TextCell]]) -> Iterator[_Record]:
    """The elements of a structure: each begins with the field that the first one begins with."""
    begins, record, before = None, _Record(), -1
    for index, name, value in fields:
        role = layout.roles.get(name)
        if role is None:
            continue
        begins = begins or role
        if role == begins and record:
            yield record
            record = _Record()
        if role in record:
            raise InputError(f"line {value.line}: {name} is repeated in an element of {layout.name}: leave one out")
        if role == begins and index is not None:
            if int(index) != before + 1:
                raise InputError(f"line {value.line}: element {index} follows element {before}; mend the file")
            before = int(index)
        record[role] = value
    if record:
        yield record


def _check_count(text: str, count: int) -> None:
    """Refuse a file whose number of points differs from its stated number."""
    stated = [(int(match[1]), line_of(text, match.start())) for match in _COUNT.finditer(text)]
    stated += [(int(match[2]) - int(match[1]) + 1, line_of(text, match.start())) for match in _BOUNDS.finditer(text)]
    for number, line in stated:
        if number != count:
            raise InputError(
                f"line {line}: the file says that it has {number} points or pieces and holds {count}: points are "
                "missing or too many; mend the number where the file is whole"
            )


def _of_records(layout: FieldLayout, records: Sequence[_Record]) -> TablePoints:
    lines = [next(iter(record.values())).line for record in records]
    for record, line in zip(records, lines, strict=True):
        missing = records[0].keys() - record.keys()
        if missing or record.keys() - records[0].keys():
            names = {role: name for name, role in layout.roles.items()}
            fields = ", ".join(sorted(names[role] for role in missing or record.keys() - records[0].keys()))
            raise InputError(
                f"line {line}: an element of {layout.name} has {'no' if missing else 'a'} {fields}, unlike the first: "
                "mend the element"
            )
    roles = records[0].keys()
    if "x" not in roles:
        return TablePoints.of_pieces(list(_pieces(layout, records, lines)), layout.name, lines=lines)
    points = list(map(_point, records))
    profiles = [_profile(layout, record) for record in records]
    straight = "type" in roles and all(profile and degree_of(profile) == 1 for profile in profiles[:-1])
    if ("type" not in roles and min(map(len, points)) < 3) or (straight and len(points) >= FEWEST_POINTS):
        # samples of a motion, whatever runs between them
        places, heights = (np.array([point[i] for point in points]) for i in (0, 1))
        digit = resolution_of([record["y"].text for record in records], heights)
        return TablePoints(places, heights, digit, layout.name, lines=lines, units=layout.units)
    pieces = pieces_between(points, profiles, lines)
    return TablePoints.of_pieces(pieces, layout.name, lines=lines, units=layout.units)


def _point(record: _Record) -> list[float]:
    """x, y and as many derivatives as are given."""
    numbers = [record[role].number() for role in "xy"]
    for role in "vaj":
        if role not in record or record[role].text.lower() in _ABSENT:
            break
        numbers.append(record[role].number())
    return numbers


def _profile(layout: FieldLayout, record: _Record) -> str | None:
    """The name of what runs after a point; None where the layout has one kind alone."""
    if "type" not in record:
        return None
    text = record["type"].text
    return (layout.profiles or {}).get(text, re.sub(r"^(?:.*[.#])?(?:MOTIONFUNCTYPE_)?", "", text)) or None


def _pieces(layout: FieldLayout, records: Sequence[_Record], lines: Sequence[int]) -> Iterator[CurvePiece]:
    begin = 0.0
    for record, line in zip(records, lines, strict=True):
        numbers = {role: value.number() for role, value in record.items() if role != "type"}
        start, stop = numbers.get("x0", begin), numbers["x1"]
        with located(f"line {line}"):
            if "c0" in numbers:
                yield powers(start, stop, [numbers[f"c{n}"] for n in range(8) if f"c{n}" in numbers])
            else:
                first, last = (
                    [numbers[f"{role}{end}"] for role in "yvaj" if f"{role}{end}" in numbers] for end in "01"
                )
                yield of_profile(_profile(layout, record), (start, stop), first, last)
        begin = stop


def _of_arrays(text: str) -> TablePoints | None:
    """Arrays of numbers: rows of points, elements of CAM_PROFILE, breaks with coefficients."""
    text = text.translate({ord("{"): "[", ord("}"): "]"})
    arrays = []
    for match in _ARRAY.finditer(text):
        if (stop := _closed(text, match.end())) is None:
            raise InputError(f"line {line_of(text, match.end())}: an array does not end: add its bracket")
        arrays.append((match[1], match.end(), text[match.end() : stop]))
    named = {name: item for item in arrays for name in ("breaks", "coefficients") if re.search(rf"{name}\b", item[0])}
    if len(named) == 2:
        return _of_source(text, named)
    tables = [(head, list(_rows(text, start, body))) for head, start, body in arrays]
    rows = max((rows for _, rows in tables), key=len, default=[])
    if len(rows) < 2:
        # one flat array of pairs
        rows = next((pairs for head, rows in tables if rows and (pairs := _pairs(head, rows[0]))), [])
    return _of_rows(text, rows) if len(rows) > 1 else None


def _of_rows(text: str, rows: list[list[TextCell]]) -> TablePoints | None:
    """Rows of two to five numbers, or elements of CAM_PROFILE."""
    width = len(rows[0])
    for row in rows:
        if len(row) != width:
            raise InputError(f"line {row[0].line}: a row of {len(row)} numbers among rows of {width}: mend the row")
    if width == _CALCULATED:
        return _of_cam_profile(_used(rows))
    if width not in {2, 3, 5}:
        return None
    rows = _used(rows)
    _check_count(text, len(rows))
    records = [dict(zip(("x", "y", "v", "a", "type")[: 2 if width == 3 else width], row, strict=False)) for row in rows]
    names = {2: "array of pairs", 3: "Rockwell CAM", 5: "RTmotion McCamXYVA"}
    layout = FieldLayout(names[width], "x=x y=y v=v a=a type=type")
    straight = any(degree_of(record["type"].text) == 1 for record in records if "type" in record)
    if not straight and min(len(_point(record)) for record in records) < 4:
        records = [{role: record[role] for role in "xy"} for record in records]
    return _of_records(layout, records)


def _closed(text: str, start: int) -> int | None:
    """The index of the closing bracket for an opening one."""
    depth = 0
    for match in re.compile(r"[\[\]]").finditer(text, start):
        depth += 1 if match[0] == "[" else -1
        if not depth:
            return match.end()
    return None


def _rows(text: str, start: int, body: str) -> Iterator[list[TextCell]]:
    for match in _INNER.finditer(body):
        cells = re.finditer(r"[^\s,()]+", match[1])
        if row := [TextCell(cell[0], line_of(text, start + match.start(1) + cell.start())) for cell in cells]:
            yield row


def _pairs(head: str, flat: list[TextCell]) -> list[list[TextCell]]:
    """The pairs of an array of two dimensions; none of another one."""
    bounds = _BOUNDS.search(head)
    if bounds is None or not bounds[3]:
        return []
    if re.search(r"(?:0\s*\.\.\s*1|1\s*\.\.\s*2)", bounds[3]) is None:
        raise InputError(f"line {flat[0].line}: an array of points has two columns, master and slave")
    if flat and len(flat) % 2:
        raise InputError(f"line {flat[-1].line}: {len(flat)} numbers are no pairs of master and slave: mend them")
    return [flat[i : i + 2] for i in range(0, len(flat), 2)]


def _used(rows: list[list[TextCell]]) -> list[list[TextCell]]:
    """The rows without repetitions of the last row at the end, and without rows of zeros."""
    texts = [[cell.text for cell in row] for row in rows]
    count = len(rows)
    while count > 2 and all(text.strip("0.") == "" for text in texts[count - 1]):
        count -= 1
    while count > 2 and texts[count - 1] == texts[count - 2]:
        count -= 1
    return rows[:count]


def _of_cam_profile(rows: Sequence[Sequence[TextCell]]) -> TablePoints:
    """Elements of CAM_PROFILE: status, X, Y, kind, C0 to C3, numbers of 64 bits in halves."""
    values = []
    for row in rows:
        halves = [int(number) for cell in row if (number := cell.number()).is_integer() and abs(number) <= 2**31]
        if len(halves) != _CALCULATED:
            raise InputError(f"line {row[0].line}: an element of CAM_PROFILE is 14 whole numbers of 32 bits")
        packed = b"".join(pack(">II", *(half & 0xFFFFFFFF for half in halves[i : i + 2])) for i in (1, 3, 6, 8, 10, 12))
        values.append(list(unpack(">6d", packed)))
        if not all(map(isfinite, values[-1])):
            raise InputError(f"line {row[0].line}: an element of CAM_PROFILE holds no finite number")
    pieces = []
    for row, (x, y, *constants), (stop, *_) in zip(rows, values, values[1:], strict=False):
        with located(f"line {row[0].line}"):
            pieces.append(powers(x, stop, [y + constants[0], *constants[1:]]))
    if len(values) < FEWEST_POINTS:
        return TablePoints.of_pieces(pieces, "Rockwell CAM_PROFILE", lines=[row[0].line for row in rows])
    # the points are the cam, and the spline through them the controller's
    places, heights = (np.array([numbers[i] for numbers in values]) for i in (0, 1))
    return TablePoints(
        places, heights, resolution_of(list(map(repr, heights.tolist())), heights), "Rockwell CAM_PROFILE"
    )


def _of_source(text: str, named: dict[str, tuple[str, int, str]]) -> TablePoints:
    """Breaks and coefficients of a function block or a header."""
    cells = {}
    for name, (head, start, body) in named.items():
        cells[name] = [cell for row in _rows(text, start, body) for cell in row]
        bounds = _BOUNDS.search(head)
        sizes = [int(size) for size in re.findall(r"\[(\d+)\]", head)]
        stated = int(bounds[2]) - int(bounds[1]) + 1 if bounds else int(np.prod(sizes)) if sizes else None
        if stated is not None and stated != len(cells[name]):
            line = line_of(text, start)
            raise InputError(
                f"line {line}: {name} are stated as {stated} numbers and are {len(cells[name])}: mend them"
            )
    breaks, flat = ([each.number(suffix="fF") for each in cells[name]] for name in ("breaks", "coefficients"))
    if not flat or len(breaks) < 2 or len(flat) % (len(breaks) - 1):
        line = line_of(text, named["coefficients"][1])
        raise InputError(f"line {line}: {len(flat)} coefficients are no rows for {len(breaks) - 1} pieces: mend them")
    width = len(flat) // (len(breaks) - 1)
    rows = [flat[i : i + width] for i in range(0, len(flat), width)]
    pieces = []
    for low, high, row, cell in zip(breaks, breaks[1:], rows, cells["breaks"], strict=False):
        with located(f"line {cell.line}"):
            pieces.append(powers(low, high, row))
    return TablePoints.of_pieces(pieces, "breaks and coefficients", lines=[cell.line for cell in cells["breaks"]])
