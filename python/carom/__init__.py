"""Frictional impact of deformable bodies, every joule accounted for."""

import re
from importlib import import_module

_LISTED = __spec__.loader.get_data(f"{__path__[0]}/__init__.pyi").decode()
_HOME_OF = {name: home for home, name in re.findall(r"from (\S+) import (\w+) as", _LISTED)}
"""The module of each name, imported when the name is first used: the command line starts sooner."""

__all__ = sorted(_HOME_OF)  # noqa: PLE0605 (type checkers read the list itself)

_ROOMS = ("contact", "friction")
"""Modules with public names of their own."""


def __getattr__(name: str) -> object:
    if name in _ROOMS:
        return import_module(f"carom.{name}")
    if name not in _HOME_OF:
        raise AttributeError(f"module 'carom' has no attribute {name!r}")
    value: object = getattr(import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_ROOMS})
