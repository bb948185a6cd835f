"""Write crates/carom-c/include/carom.f90, the Fortran module, from carom.h.

``python tools/make_fortran.py`` reads the header as cbindgen writes it. With ``--check`` nothing is
written, and the exit status is 1 if the module is not up to date.
"""

from __future__ import annotations

import argparse
import re
import sys
import textwrap
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "crates" / "carom-c" / "include"
HEADER, MODULE = FOLDER / "carom.h", FOLDER / "carom.f90"

HANDLES = {"carom_setup", "carom_contact"}
"""Structures of which only addresses are known."""

SCALARS = {"count", "entries", "missed"}
"""Names of what is written as one number; other pointers to numbers are arrays."""

MAY_BE_ABSENT = {
    ("carom_contact_search", "velocity"),
    ("carom_friction_solve", "method"),
    ("carom_friction_solve", "report"),
}
"""Arguments that may be null."""

KINDS = {
    "double": "real(c_double)",
    "size_t": "integer(c_size_t)",
    "int32_t": "integer(c_int32_t)",
    "int": "integer(c_int)",
}

TOP = """\
! carom: exact frictional contact in time loops of your own.
!
! Written by `python tools/make_fortran.py` from carom.h, whose comments say what holds of all
! calls; do not edit.
!
! Texts end with c_null_char. nodes and unknowns are numbered from 0. An array of shape
! [a][b] in C is one of shape (b, a) here: points have shape (dimension, point_count), and of frames
! the column (:, 1, i) is the normal. A solver is c_funloc of a function with the interface
! `carom_solver`.
module carom
  use, intrinsic :: iso_c_binding
  implicit none
  public
"""

SOLVER = """\
  abstract interface
    !> Solves K x = b for several right-hand sides with your symmetric, positive definite K; 0 says
    !> that solutions were found. Solutions are zero before. context is what was given with it.
    function carom_solver(context, unknowns, columns, right_hand_sides, solutions) bind(c)
      import
      type(c_ptr), value :: context
      integer(c_size_t), value :: unknowns, columns
      real(c_double), intent(in) :: right_hand_sides(unknowns, columns)
      real(c_double), intent(inout) :: solutions(unknowns, columns)
      integer(c_int) :: carom_solver
    end function
  end interface
"""

MESSAGE = """\
contains

  !> What the last call of this thread has to say, as a text of Fortran.
  function carom_message() result(text)
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    type(c_ptr) :: said
    integer :: k

    said = carom_last_error()
    call c_f_pointer(said, letters, [huge(k)])
    k = 1
    do while (letters(k) /= c_null_char)
      k = k + 1
    end do
    allocate (character(k - 1) :: text)
    do k = 1, len(text)
      text(k:k) = letters(k)
    end do
  end function
end module
"""

COMMENT = r"/\*\*\n(?P<said>(?: \*[^\n]*\n)+?) \*/\n"
ENUM = re.compile(r"typedef enum carom_status \{(.*?)\} carom_status;", re.DOTALL)
STRUCT = re.compile(COMMENT + r"typedef struct (\w+) \{(.*?)\} \w+;", re.DOTALL)
FUNCTION = re.compile(COMMENT + r"(enum carom_status|const char \*|void) ?(\w+)\(([^;]*)\);")


def main() -> int:
    """Run the script."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="only say whether it is up to date")
    check = parser.parse_args().check
    written = module(HEADER.read_text(encoding="utf-8"))
    if check:
        if not MODULE.exists() or MODULE.read_text(encoding="utf-8") != written:
            print(f"{MODULE.name}: out of date; run python tools/make_fortran.py", file=sys.stderr)
            return 1
        return 0
    MODULE.write_text(written, encoding="utf-8")
    return 0


def module(header: str) -> str:
    """Return the module of a header."""
    (statuses,) = ENUM.findall(header)
    parts = [TOP]
    for name, value in re.findall(r"(CAROM_\w+) = (\d+)", statuses):
        parts.append(f"  integer(c_int), parameter :: {name} = {value}\n")
    parts.append("\n")
    parts += [structure(*found) for found in STRUCT.findall(header)]
    parts += [SOLVER, "\n  interface\n"]
    parts += [function(*found) for found in FUNCTION.findall(header)]
    parts += ["  end interface\n\n", MESSAGE]
    return "".join(parts)


def comment(said: str, indent: str) -> str:
    """Return the comment of C as one of Fortran."""
    text = " ".join(line.removeprefix(" *").strip() for line in said.splitlines())
    return textwrap.fill(text, 110, initial_indent=f"{indent}!> ", subsequent_indent=f"{indent}!> ")


def structure(said: str, name: str, body: str) -> str:
    """Return a structure as a type."""
    fields = re.sub(r"/\*.*?\*/", "", body, flags=re.DOTALL)
    lines = [comment(said, "  "), f"  type, bind(c) :: {name}"]
    for kind, star, field in re.findall(r"([\w ]+?) (\*?)(\w+);", fields):
        lines.append(f"    {'type(c_ptr)' if star else by_value(kind.strip())} :: {field}")
    return "\n".join([*lines, f"  end type {name}\n\n"])


def by_value(kind: str) -> str:
    """Return the type of something that is no pointer."""
    return KINDS.get(kind) or f"type({kind.removeprefix('struct ')})"


def function(said: str, result: str, name: str, arguments: str) -> str:
    """Return the interface of a function."""
    given = [re.sub(r"\s+", " ", each).strip() for each in arguments.split(",")]
    given = [each for each in given if each != "void"]
    names = [re.split(r"[ *]", each)[-1] for each in given]
    what = "subroutine" if result == "void" else "function"
    head = f"{what} {name}({', '.join(names)}) bind(c)"
    lines = [comment(said, "    "), *wrapped(head), "      import"]
    lines += [f"      {argument(name, each)}" for each in given]
    if what == "function":
        kind = "type(c_ptr)" if "*" in result else "integer(c_int)"
        lines.append(f"      {kind} :: {name}")
    return "\n".join([*lines, f"    end {what}\n\n"])


def wrapped(line: str) -> list[str]:
    """Return a line as lines that Fortran reads."""
    lines = textwrap.wrap(line, 110, initial_indent="    ", subsequent_indent="        ")
    return [f"{each} &" for each in lines[:-1]] + lines[-1:]


def argument(function: str, declared: str) -> str:
    """Return the declaration of an argument."""
    kind, stars, name = re.fullmatch(r"([\w ]+?) ?(\**)(\w+)", declared).groups()
    is_given = kind.startswith("const ")
    kind = kind.removeprefix("const ").removeprefix("struct ")
    absent = ", optional" if (function, name) in MAY_BE_ABSENT else ""
    if kind == "carom_solver":
        what = "type(c_funptr), value"
    elif stars == "**":
        what = "type(c_ptr), intent(out)"
    elif kind in HANDLES or kind == "void":
        what = "type(c_ptr), value"
    elif not stars:
        what = f"{by_value(kind)}, value"
    elif kind == "char":
        what, name = "character(kind=c_char), intent(in)", f"{name}(*)"
    elif kind.startswith("carom_") or name in SCALARS:
        what = f"{by_value(kind)}, intent({'in' if is_given else 'out'}){absent}"
    else:
        what = f"{KINDS[kind]}, intent({'in' if is_given else 'inout'}){absent}"
        name = f"{name}(*)"
    return f"{what} :: {name}"


if __name__ == "__main__":
    sys.exit(main())
