"""Cases to begin with."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from types import MappingProxyType

from carom.errors import InputError
from carom.io.sparing import spare_file
from carom.messages import known

TEMPLATES = MappingProxyType(
    {
        "drop-test": "a battery falls from 1 m on its edge, in space, with friction",
        "two-bodies": "two rubber discs hit each other off their centres",
        "wall-bounce": "a disc is thrown obliquely at a wall and spins away",
        "static-hertz": "a ball is pressed into a block, to compare with Hertz",
        "press-fit": "a shaft is pressed into a hub, to compare with Lamé",
        "seal": "a rubber cord is squeezed between plates, as an O-ring is",
        "pile": "grains of many sizes fall into a box and settle",
        "rigid": "a rigid block falls on a rubber pad and is thrown back",
        "planted": "a script that plants carom's contact in a code of your own",
        "mesh-file": "a part from a mesh file (--mesh) is thrown at a floor",
    }
)
"""Names of the templates and what each computes."""

MESH_FILE = "mesh-file"
"""The template that needs a mesh."""


SCRIPTS = frozenset({"planted"})
"""Templates that are scripts of Python and no case files."""


def file_name(name: str) -> str:
    """Return what the file of a template is called."""
    return f"{name}.py" if name in SCRIPTS else f"{name}.toml"


def template(name: str) -> str:
    """Return the text of a template; that of `MESH_FILE` has places to fill.

    Raises
    ------
    InputError
        There is no such template.
    """
    if name not in TEMPLATES:
        raise InputError(f"no template {name!r}; {known(name, TEMPLATES)}")
    file = resources.files("carom.new") / "templates" / file_name(name)
    return file.read_text(encoding="utf-8")


def place(text: str, file: Path, *, force: bool = False) -> None:
    """Write a new case file.

    Raises
    ------
    InputError
        There is such a file already, and `force` does not say to replace it; or it cannot be there.
    """
    spare_file(file, force=force)
    file.write_text(text, encoding="utf-8")
