"""Formulas of a case as the auditor reads them: by Python's own grammar, in NumPy's functions."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from functools import reduce

import numpy as np

from carom.auditing.arrays import Array
from carom.errors import InputError

_CONSTANTS = {"pi": np.pi, "e": np.e}

_OPERATORS: Mapping[type[ast.AST], Callable[..., Array]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.power,
    ast.USub: np.negative,
    ast.UAdd: np.positive,
    ast.Lt: np.less,
    ast.LtE: np.less_equal,
    ast.Gt: np.greater,
    ast.GtE: np.greater_equal,
}

_FUNCTIONS: Mapping[str, Callable[..., Array]] = {
    "abs": np.abs,
    "acos": np.arccos,
    "asin": np.arcsin,
    "atan": np.arctan,
    "cos": np.cos,
    "cosh": np.cosh,
    "exp": np.exp,
    "log": np.log,
    "max": lambda *x: reduce(np.maximum, x),
    "min": lambda *x: reduce(np.minimum, x),
    "sign": np.sign,
    "sin": np.sin,
    "sinh": np.sinh,
    "sqrt": np.sqrt,
    "step": lambda x: np.where(x >= 0, 1.0, 0.0),
    "tan": np.tan,
    "tanh": np.tanh,
    "where": lambda test, yes, no: np.choose(test != 0, [no, yes]),
}


class Formula:
    """A formula of some variables.

    Parameters
    ----------
    text
        The formula as in the case file.

    Raises
    ------
    InputError
        It is none that the auditor can read.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        try:
            # The grammar of the case file is that of Python, which writes powers with two stars.
            self._root = ast.parse(text.strip().replace("^", "**"), mode="eval").body
        except (SyntaxError, ValueError) as error:
            raise InputError(f"cannot audit the formula {text!r}: {error}") from error

    def names(self) -> set[str]:
        """Return the names that it mentions, those of functions too."""
        return {node.id for node in ast.walk(self._root) if isinstance(node, ast.Name)}

    def __call__(self, **variables: Array) -> Array:
        """Return its values where the variables have these."""
        return np.asarray(self._value(self._root, {**_CONSTANTS, **variables}), dtype=np.float64)

    def _value(self, node: ast.AST, known: Mapping[str, Array | float]) -> Array:
        def at(child: ast.AST) -> Array:
            return self._value(child, known)

        match node:
            case ast.Constant(value=float() | int() as number):
                return np.array(float(number))
            case ast.Name(id=name) if name in known:
                return np.asarray(known[name])
            case ast.UnaryOp(op=op, operand=operand) if type(op) in _OPERATORS:
                return _OPERATORS[type(op)](at(operand))
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                return _OPERATORS[type(op)](at(left), at(right))
            case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _OPERATORS:
                return np.asarray(_OPERATORS[type(op)](at(left), at(right)), dtype=np.float64)
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
                return _FUNCTIONS[name](*(at(argument) for argument in args))
        raise InputError(f"cannot audit the formula {self.text!r}")
