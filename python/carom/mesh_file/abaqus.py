"""The mesh in an Abaqus input file: nodes, elements, sets and surfaces.

meshio's own reader leaves out surfaces, plane strain elements and all but the last block of nodes.
Keywords that say nothing about the mesh are skipped, and so are elements that are no continuum,
such as springs. The numbering of elements and of their faces is that of the Abaqus Analysis User's
Guide, "Continuum elements".
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from carom.display.counting import count
from carom.mesh_file.arrays import FileMesh, Indices, Note, Refused
from carom.mesh_file.cells import dimension
from carom.mesh_file.deck import Row, sections

_NO_CONTINUUM = re.compile(
    r"(SPRING|DASHPOT|MASS|ROTARYI|GAP|ITS|CONN|DCOUP|JOINT|PIPE|ELBOW|FRAME|RB[23]D|U\d|D$)"
)
"""Beginnings of the names of elements that carry forces between nodes or flows, but fill no space.

U followed by a number is a user's element, D an element of CalculiX' networks.
"""

_BEAM = re.compile(r"B[23]\d")

_ELEMENTS = {  # nodes per element: kind, by the letters that begin its name
    "C3D": {4: "tetra", 10: "tetra10", 8: "hexahedron", 20: "hexahedron20", 27: "hexahedron27"}
    | {6: "wedge", 15: "wedge15"},
    "CPE": {3: "triangle", 6: "triangle6", 4: "quad", 8: "quad8"},
    "CPS": {3: "triangle", 6: "triangle6", 4: "quad", 8: "quad8"},
    "CAX": {3: "triangle", 6: "triangle6", 4: "quad", 8: "quad8"},
    "M3D": {3: "triangle", 6: "triangle6", 4: "quad", 8: "quad8", 9: "quad9"},
    "SFM3D": {3: "triangle", 6: "triangle6", 4: "quad", 8: "quad8"},
    "S": {3: "triangle", 6: "triangle6", 4: "quad", 8: "quad8", 9: "quad9"},
    "STRI": {3: "triangle", 65: "triangle6"},
    "R3D": {3: "triangle", 4: "quad"},
    "T3D": {2: "line", 3: "line3"},
    "T2D": {2: "line", 3: "line3"},
    "R2D": {2: "line"},
}
_TRIQUADRATIC = (*range(20), 26, 24, 23, 25, 21, 22, 20)
"""Nodes of C3D27, the middle of the element first among the last seven, in the order of VTK."""

_NODES = {
    "line": 2, "line3": 3, "triangle": 3, "triangle6": 6, "quad": 4, "quad8": 8, "quad9": 9,
    "tetra": 4, "tetra10": 10, "hexahedron": 8, "hexahedron20": 20, "hexahedron27": 27, "wedge": 6,
    "wedge15": 15,
}  # fmt: skip

# Faces 1, 2, … of an element: kind and local nodes.
_TRIANGLE_FACES = [(0, 1), (1, 2), (2, 0)]
_QUAD_FACES = [(0, 1), (1, 2), (2, 3), (3, 0)]
_TETRA_FACES = [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]
_HEX_FACES = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
_FACES: dict[str, Sequence[tuple[int, ...]]] = {
    "triangle": _TRIANGLE_FACES,
    "triangle6": [(0, 1, 3), (1, 2, 4), (2, 0, 5)],
    "quad": _QUAD_FACES,
    "quad8": [(0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)],
    "tetra": _TETRA_FACES,
    "tetra10": [(0, 1, 2, 4, 5, 6), (0, 3, 1, 7, 8, 4), (1, 3, 2, 8, 9, 5), (2, 3, 0, 9, 7, 6)],
    "wedge": [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    "wedge15": [
        (0, 1, 2, 6, 7, 8),
        (3, 5, 4, 11, 10, 9),
        (0, 3, 4, 1, 12, 9, 13, 6),
        (1, 4, 5, 2, 13, 10, 14, 7),
        (2, 5, 3, 0, 14, 11, 12, 8),
    ],
    "hexahedron": _HEX_FACES,
    "hexahedron20": [
        (0, 1, 2, 3, 8, 9, 10, 11),
        (4, 7, 6, 5, 15, 14, 13, 12),
        (0, 4, 5, 1, 16, 12, 17, 8),
        (1, 5, 6, 2, 17, 13, 18, 9),
        (2, 6, 7, 3, 18, 14, 19, 10),
        (3, 7, 4, 0, 19, 15, 16, 11),
    ],
    # These are numbered as VTK does.
    "hexahedron27": [
        (0, 1, 2, 3, 8, 9, 10, 11, 24),
        (4, 7, 6, 5, 15, 14, 13, 12, 25),
        (0, 4, 5, 1, 16, 12, 17, 8, 22),
        (1, 5, 6, 2, 17, 13, 18, 9, 21),
        (2, 6, 7, 3, 18, 14, 19, 10, 23),
        (3, 7, 4, 0, 19, 15, 16, 11, 20),
    ],
}


def read_abaqus(path: Path) -> FileMesh:
    """Read the mesh of one part, or of a flat file.

    Raises
    ------
    Refused
        The file is not as the format asks, or has several parts or instances.
    """
    reader = _Reader()
    try:
        for keyword, options, rows in sections(path):
            reader.take(keyword, options, rows)
        return reader.mesh()
    except (OSError, UnicodeDecodeError, ValueError, IndexError, OverflowError) as error:
        raise Refused(f"cannot be read: {error}") from None


_FACE_KINDS = {
    **{(2, 2): "line", (2, 3): "line3", (3, 3): "triangle", (3, 6): "triangle6"},
    **{(3, 4): "quad", (3, 8): "quad8", (3, 9): "quad9"},
}
"""Kinds of faces, by the dimension of the cell and the number of their nodes."""

_Members = dict[int, bool]
"""Numbers of a set; true for those that it names one by one, and that must therefore be there."""


_SHELLS = ("triangle", "triangle6", "quad", "quad8", "quad9")


@dataclass
class _Reader:
    """What has been read; names of sets are the same in capitals and small letters."""

    points: dict[int, list[float]] = field(default_factory=dict)
    blocks: list[tuple[str, dict[int, list[int]]]] = field(default_factory=list)
    node_sets: dict[str, _Members] = field(default_factory=dict)
    element_sets: dict[str, _Members] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[int, str, bool]]] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)
    left_out: dict[str, set[int]] = field(default_factory=dict)
    parts: int = 0

    def take(self, keyword: str, options: dict[str, str], rows: list[Row]) -> None:
        if keyword in ("PART", "INSTANCE"):
            self.parts += keyword == "PART"
            if self.parts > 1 or (keyword == "INSTANCE" and rows):
                raise ValueError(
                    "it has several parts or moved instances; write one part to a file"
                )
        elif keyword == "NODE":
            numbers = [row.integer(0) for row in rows]
            for number, row in zip(numbers, rows, strict=True):
                x = [row.number(k) for k in range(1, min(len(row.fields), 4))]
                self.points[number] = x + [0.0] * (3 - len(x))
            self._add(self.node_sets, options.get("NSET"), dict.fromkeys(numbers, True))
        elif keyword == "ELEMENT":
            self._elements(options, rows)
        elif keyword in ("NSET", "ELSET"):
            sets = self.node_sets if keyword == "NSET" else self.element_sets
            self._add(sets, options.get(keyword), self._members(sets, options, rows))
        elif keyword == "SURFACE":
            self._surface(options, rows)

    def mesh(self) -> FileMesh:
        """Return what was read, numbered from 0."""
        index = {number: k for k, number in enumerate(self.points)}
        place = {
            number: (block, k)
            for block, (_, elements) in enumerate(self.blocks)
            for k, number in enumerate(elements)
        }
        blocks = [(kind, _indices(index, list(cells.values()))) for kind, cells in self.blocks]
        cell_sets: dict[str, list[list[int]]] = {}
        without = set().union(*self.left_out.values())
        for name, numbers in self.element_sets.items():
            members: list[list[int]] = [[] for _ in blocks]
            for number, must_be in numbers.items():
                if number not in place:
                    if not must_be or number in without:
                        continue
                    raise ValueError(f"element set {name} has element {number}, which is not there")
                block, k = place[number]
                members[block].append(k)
            cell_sets[name] = members
        for name, faces in self.surfaces.items():
            for kind, nodes in self._faces(name, faces, place):
                cell_sets.setdefault(name, [[] for _ in blocks])
                cell_sets[name] += [[] for _ in range(len(blocks) - len(cell_sets[name]))]
                cell_sets[name].append(list(range(len(nodes))))
                blocks.append((kind, _indices(index, nodes)))
        return FileMesh(
            points=np.array(list(self.points.values()), dtype=np.float64).reshape(-1, 3),
            blocks=blocks,
            point_sets={
                self.names[n]: _indices(index, [k for k, must in of.items() if must or k in index])
                for n, of in self.node_sets.items()
            },
            cell_sets={
                self.names[name]: [
                    np.array(members[k] if k < len(members) else [], dtype=np.int64)
                    for k in range(len(blocks))
                ]
                for name, members in cell_sets.items()
            },
            notes=self._notes(),
        )

    def _notes(self) -> list[Note]:
        if not self.left_out:
            return []
        kinds = ", ".join(
            f"{count(len(numbers), f'{kind} element')}" for kind, numbers in self.left_out.items()
        )
        return [
            Note(
                "left-out-elements",
                f"left out {kinds}, which fill no space",
                value=sum(map(len, self.left_out.values())),
                allowed=0,
                remedy="what they hold or join is free now: see to it with motions and loads",
            )
        ]

    def _add(self, sets: dict[str, _Members], name: str | None, members: _Members) -> None:
        if name:
            self.names.setdefault(name.upper(), name)
            mine = sets.setdefault(name.upper(), {})
            for number, must_be in members.items():
                mine[number] = must_be or mine.get(number, False)

    def _elements(self, options: dict[str, str], rows: list[Row]) -> None:
        element = options.get("TYPE", "").upper()
        if _NO_CONTINUUM.match(element) or _BEAM.match(element):
            numbers = [row.integer(0) for row in rows if not row.goes_on]
            self.left_out.setdefault(element, set()).update(numbers)
            self._add(self.element_sets, options.get("ELSET"), dict.fromkeys(numbers, True))
            return
        kind = _kind(element)
        flat = [row.integer(k) for row in rows for k in range(len(row.fields))]
        width = 1 + _NODES[kind]
        if len(flat) % width:
            raise ValueError(f"elements of type {options['TYPE']} need {width - 1} nodes each")
        elements = {flat[k]: flat[k + 1 : k + width] for k in range(0, len(flat), width)}
        if kind == "hexahedron27":
            elements = {n: [nodes[k] for k in _TRIQUADRATIC] for n, nodes in elements.items()}
        self.blocks.append((kind, elements))
        self._add(self.element_sets, options.get("ELSET"), dict.fromkeys(elements, True))

    def _members(
        self, sets: dict[str, _Members], options: dict[str, str], rows: list[Row]
    ) -> _Members:
        members: _Members = {}
        for row in rows:
            if "GENERATE" in options:
                first, last, step = (*map(row.integer, range(len(row.fields))), 1)[:3]
                for number in range(first, last + 1, step):
                    members.setdefault(number, False)
                continue
            for column, entry in enumerate(row.fields):
                if re.fullmatch(r"\d+", entry):
                    members[row.integer(column)] = True
                elif entry.upper() in sets:
                    for number, must_be in sets[entry.upper()].items():
                        members[number] = must_be or members.get(number, False)
                elif entry:
                    raise ValueError(f"there is no set {entry}")
        return members

    def _surface(self, options: dict[str, str], rows: list[Row]) -> None:
        name = options.get("NAME", "")
        if options.get("TYPE", "ELEMENT").upper() == "NODE":
            self._add(
                self.node_sets, name, self._members(self.node_sets, {}, [r.first() for r in rows])
            )
            return
        self.names.setdefault(name.upper(), name)
        faces = self.surfaces.setdefault(name.upper(), [])
        for row in rows:
            face = row.fields[1].upper() if len(row.fields) > 1 else ""
            of_row = self._members(self.element_sets, {}, [row.first()])
            faces.extend((number, face, must_be) for number, must_be in of_row.items())

    def _faces(
        self, name: str, faces: list[tuple[int, str, bool]], place: dict[int, tuple[int, int]]
    ) -> list[tuple[str, list[list[int]]]]:
        """Return the nodes of the faces of a surface, by kind."""
        found: dict[str, list[list[int]]] = {}
        without = set().union(*self.left_out.values())
        for number, face, must_be in faces:
            if number not in place:
                if not must_be or number in without:
                    continue
                raise ValueError(f"surface {name} has element {number}, which is not there")
            kind, elements = self.blocks[place[number][0]]
            if face in ("SPOS", "SNEG") and kind in _SHELLS:
                found.setdefault(kind, []).append(elements[number])
                continue
            if kind not in _FACES:
                continue
            local = _FACES[kind]
            digits = re.fullmatch(r"S([1-6])", face)
            if digits is None or int(digits[1]) > len(local):
                raise ValueError(
                    f'surface {name} has a face "{face}", which a {kind} does not have'
                )
            nodes = [elements[number][k] for k in local[int(digits[1]) - 1]]
            found.setdefault(_FACE_KINDS[dimension(kind), len(nodes)], []).append(nodes)
        return list(found.items())


def _kind(element: str) -> str:
    """Return the kind of cell that a type of element is."""
    match = re.match(r"([A-Z]+(?:3D|2D)?)(\d+)", element)
    kind = _ELEMENTS.get(match[1], {}).get(int(match[2])) if match else None
    if kind is None:
        raise ValueError(f"elements of type {element or '(none)'} are not known")
    return kind


def _indices(index: dict[int, int], numbers: list[int] | list[list[int]]) -> Indices:
    """Return node numbers as indices."""
    array = np.array(numbers, dtype=np.int64)
    try:
        return np.array([index[n] for n in array.ravel().tolist()], dtype=np.int64).reshape(
            array.shape
        )
    except KeyError as error:
        raise ValueError(f"node {error} is not there") from None
