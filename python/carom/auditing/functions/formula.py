"""Formulas of a case as the auditor reads them: by Python's own grammar, in NumPy's functions."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
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


_SLOPES: Mapping[str, Callable[[float], float]] = {
    "abs": lambda x: float(np.sign(x)),
    "acos": lambda x: -1.0 / float(np.sqrt(1.0 - x * x)),
    "asin": lambda x: 1.0 / float(np.sqrt(1.0 - x * x)),
    "atan": lambda x: 1.0 / (1.0 + x * x),
    "cos": lambda x: -float(np.sin(x)),
    "cosh": lambda x: float(np.sinh(x)),
    "exp": lambda x: float(np.exp(x)),
    "log": lambda x: 1.0 / x,
    "sign": lambda _: 0.0,
    "sin": lambda x: float(np.cos(x)),
    "sinh": lambda x: float(np.cosh(x)),
    "sqrt": lambda x: 0.5 / float(np.sqrt(x)),
    "step": lambda _: 0.0,
    "tan": lambda x: 1.0 + float(np.tan(x)) ** 2,
    "tanh": lambda x: 1.0 - float(np.tanh(x)) ** 2,
}
"""Derivatives of the functions of one argument."""

Dual = tuple[float, float]
"""A value and its rate."""


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
        raise AssertionError(f"{self.text!r} is a formula to the solver")

    def with_rate(self, variable: str, at: float) -> Dual:
        """Return its value and its rate to the right where a variable has this value."""
        return self._dual(self._root, variable, at)

    def _dual(self, node: ast.AST, variable: str, at: float) -> Dual:
        def of(child: ast.AST) -> Dual:
            return self._dual(child, variable, at)

        match node:
            case ast.Name(id=name) if name == variable:
                return at, 1.0
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                value, rate = of(operand)
                return -value, -rate
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return of(operand)
            case ast.BinOp(left=left, op=op, right=right):
                return _combined(op, of(left), of(right))
            case ast.Call(func=ast.Name(id=name), args=args):
                return _called(name, [of(argument) for argument in args])
        # Numbers, constants and comparisons do not change.
        return float(self._value(node, {**_CONSTANTS, variable: np.array(at)})), 0.0


def _combined(op: ast.operator, a: Dual, b: Dual) -> Dual:
    (x, dx), (y, dy) = a, b
    match op:
        case ast.Add():
            return x + y, dx + dy
        case ast.Sub():
            return x - y, dx - dy
        case ast.Mult():
            return x * y, dx * y + x * dy
        case ast.Div():
            return x / y, (dx - x / y * dy) / y
    power = float(np.power(x, y))
    rate = y * float(np.power(x, y - 1.0)) * dx if dx != 0.0 else 0.0
    return power, rate + (power * float(np.log(x)) * dy if dy != 0.0 else 0.0)


def _called(name: str, arguments: Sequence[Dual]) -> Dual:
    if name == "where":
        return arguments[1] if arguments[0][0] != 0.0 else arguments[2]
    if name == "max":
        # Of equal ones that which is about to be larger.
        return max(arguments)
    if name == "min":
        return min(arguments)
    value, rate = arguments[0]
    slope = _SLOPES[name](value) * rate if rate != 0.0 else 0.0
    return float(_FUNCTIONS[name](np.array(value))), slope
