"""Formulas: functions of x, y and z, or of u and v, from a text or from a Python callable that is traced."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _native
from ._arrays import number, vector
from ._objects import Object

Step = tuple[str, tuple[int, ...], float]


class Expression:
    """A value that depends on x, y and z (or u and v) while a formula is traced.

    Python's operators, `abs`, `min` and `max` by this module's functions of these names, and NumPy's functions of one or
    two numbers (`np.sin`, `np.sqrt`, `np.minimum` ...) work on it. It has no truth value: use `durer.where(a, b, c)`.

    Examples
    --------
    >>> import durer
    >>> seen = []
    >>> ball = durer.formula(lambda x, y, z: seen.append(x) or x * x + y * y + z * z - 1, ball=((0, 0, 0), 2))
    >>> type(seen[0])
    <class 'durer._formula.Expression'>
    """

    __slots__ = ("_tape", "_index")
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, tape: _Tape, index: int) -> None:
        self._tape, self._index = tape, index

    def __add__(self, other: Any) -> Expression:
        return self._tape.two("add", self, other)

    def __radd__(self, other: Any) -> Expression:
        return self._tape.two("add", other, self)

    def __sub__(self, other: Any) -> Expression:
        return self._tape.two("sub", self, other)

    def __rsub__(self, other: Any) -> Expression:
        return self._tape.two("sub", other, self)

    def __mul__(self, other: Any) -> Expression:
        return self._tape.two("mul", self, other)

    def __rmul__(self, other: Any) -> Expression:
        return self._tape.two("mul", other, self)

    def __truediv__(self, other: Any) -> Expression:
        return self._tape.two("div", self, other)

    def __rtruediv__(self, other: Any) -> Expression:
        return self._tape.two("div", other, self)

    def __mod__(self, other: Any) -> Any:
        """As Python and NumPy have it: with the sign of the divisor."""
        tape = self._tape
        quotient = tape.one("floor", self / other)
        return self - quotient * other

    def __pow__(self, other: Any) -> Expression:
        if isinstance(other, (int, float, np.integer)):
            power = float(other)
            if power.is_integer() and abs(power) < 1024:
                return self._tape.push("powi", (self._index,), power)
        return self._tape.two("pow", self, other)

    def __rpow__(self, other: Any) -> Expression:
        return self._tape.two("pow", other, self)

    def __neg__(self) -> Expression:
        return self._tape.one("neg", self)

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return self._tape.one("abs", self)

    def __lt__(self, other: Any) -> Expression:
        return self._tape.two("less", self, other)

    def __le__(self, other: Any) -> Expression:
        return self._tape.two("less_equal", self, other)

    def __gt__(self, other: Any) -> Expression:
        return self._tape.two("less", other, self)

    def __ge__(self, other: Any) -> Expression:
        return self._tape.two("less_equal", other, self)

    def __bool__(self) -> bool:
        raise TypeError("a traced value has no truth: write durer.where(condition, a, b) in place of if")

    def __float__(self) -> float:
        raise TypeError("a traced value is no number: use NumPy's functions in place of math's")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **kwargs: Any) -> Any:
        if method != "__call__" or kwargs:
            return NotImplemented
        name = _UFUNCS.get(ufunc.__name__)
        if name is None:
            raise TypeError(f"np.{ufunc.__name__} cannot be part of a formula")
        return FUNCTIONS[name](*inputs)

    def __repr__(self) -> str:
        return f"<value {self._index} of a formula>"


class _Tape:
    """The steps of a formula while it is traced; equal steps are kept once."""

    def __init__(self) -> None:
        self.steps: list[Step] = []
        self._known: dict[Step, int] = {}

    def push(self, name: str, operands: tuple[int, ...], number: float = 0.0) -> Expression:
        step = (name, operands, number)
        index = self._known.get(step)
        if index is None or (name == "constant" and number == 0.0):
            index = len(self.steps)
            self.steps.append(step)
            self._known[step] = index
        return Expression(self, index)

    def index(self, value: Any) -> int:
        if isinstance(value, Expression):
            if value._tape is not self:
                raise ValueError("formula: a value of another formula was used")
            return value._index
        return self.push("constant", (), number(value, "formula"))._index

    def one(self, name: str, a: Any) -> Expression:
        return self.push(name, (self.index(a),))

    def two(self, name: str, a: Any, b: Any) -> Expression:
        return self.push(name, (self.index(a), self.index(b)))


def _tape_of(*values: Any) -> _Tape | None:
    return next((v._tape for v in values if isinstance(v, Expression)), None)


def _unary(name: str, plain: Callable[[float], float]) -> Callable[[Any], Any]:
    def function(a: Any) -> Any:
        tape = _tape_of(a)
        return plain(a) if tape is None else tape.one(name, a)

    return function


def _binary(name: str, plain: Callable[[float, float], float]) -> Callable[[Any, Any], Any]:
    def function(a: Any, b: Any) -> Any:
        tape = _tape_of(a, b)
        return plain(a, b) if tape is None else tape.two(name, a, b)

    return function


def _many(name: str, plain: Callable[..., float]) -> Callable[..., Any]:
    def function(first: Any, *others: Any) -> Any:
        tape = _tape_of(first, *others)
        if tape is None:
            return plain(first, *others) if others else first
        for other in others:
            first = tape.two(name, first, other)
        return first

    return function


def where(condition: Any, a: Any, b: Any) -> Any:
    """`a` where the condition holds, else `b`: the `if` of formulas.

    Examples
    --------
    >>> import durer
    >>> f = durer.formula(lambda x, y, z: durer.where(z < 0, x*x + y*y, x*x + y*y + z*z) - 1, box=((-2,)*3, (2,)*3))
    >>> f
    formula(<lambda>, box=((-2.0, -2.0, -2.0), (2.0, 2.0, 2.0)))
    """
    tape = _tape_of(condition, a, b)
    if tape is None:
        return a if condition else b
    c, yes, no = tape.index(condition), tape.index(a), tape.index(b)
    return tape.push("select", (c, yes, no, yes))


def _square(a: Any) -> Any:
    return a**2


FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{
        name: _unary(name, getattr(math, name))
        for name in (
            "sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp log log10 floor ceil trunc sqrt"
        ).split()
    },
    "abs": _unary("abs", abs),
    "min": _many("min", min),
    "max": _many("max", max),
    "pow": lambda a, b: a**b,
    "atan2": _binary("atan2", math.atan2),
    "fmod": _binary("rem", math.fmod),
    "mod": lambda a, b: a % b,
    "hypot": lambda a, b: FUNCTIONS["sqrt"](a * a + b * b),
    "square": _square,
    "where": where,
    "neg": lambda a: -a,
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "less": lambda a, b: a < b,
    "less_equal": lambda a, b: a <= b,
    "greater": lambda a, b: a > b,
    "greater_equal": lambda a, b: a >= b,
}

_UFUNCS = {
    **{n: n for n in "sin cos tan sinh cosh tanh exp log log10 floor ceil trunc sqrt square hypot fmod".split()},
    **{"arc" + n[1:]: n for n in "asin acos atan asinh acosh atanh".split()},
    **{n: n for n in "asin acos atan asinh acosh atanh less less_equal greater greater_equal".split()},
    "arctan2": "atan2",
    "absolute": "abs",
    "fabs": "abs",
    "minimum": "min",
    "maximum": "max",
    "fmin": "min",
    "fmax": "max",
    "power": "pow",
    "remainder": "mod",
    "negative": "neg",
    "add": "add",
    "subtract": "sub",
    "multiply": "mul",
    "divide": "div",
    "true_divide": "div",
}

_BINARY = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div", ast.Mod: "mod", ast.Pow: "pow"}
_COMPARE = {ast.Lt: "less", ast.LtE: "less_equal", ast.Gt: "greater", ast.GtE: "greater_equal"}


class _Reader:
    """Walks over the tree of a text: numbers, names, operators and calls of known functions, and nothing else."""

    def __init__(self, text: str, names: dict[str, Any]) -> None:
        self.text, self.names = text, names

    def fail(self, node: ast.expr, what: str) -> ValueError:
        column = node.col_offset
        return ValueError(f"formula: {what}\n  {self.text}\n  {' ' * column}^")

    def value(self, node: ast.expr) -> Any:
        match node:
            case ast.Constant(value=int() | float() as constant) if not isinstance(constant, bool):
                return float(constant)
            case ast.Name(id=name):
                if name not in self.names:
                    raise self.fail(node, f"'{name}' is unknown; there are {', '.join(self.names)}")
                return self.names[name]
            case ast.UnaryOp(op=ast.USub(), operand=a):
                return -self.value(a)
            case ast.UnaryOp(op=ast.UAdd(), operand=a):
                return self.value(a)
            case ast.BinOp(left=a, op=ast.Pow(), right=b):
                return self.value(a) ** self.value(b)
            case ast.BinOp(left=a, op=op, right=b) if type(op) in _BINARY:
                return FUNCTIONS[_BINARY[type(op)]](self.value(a), self.value(b))
            case ast.BinOp(op=ast.BitXor()):
                raise self.fail(node, "powers are written **")
            case ast.Compare(left=a, ops=[op], comparators=[b]) if type(op) in _COMPARE:
                return FUNCTIONS[_COMPARE[type(op)]](self.value(a), self.value(b))
            case ast.IfExp(test=c, body=a, orelse=b):
                return where(self.value(c), self.value(a), self.value(b))
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
                if name not in FUNCTIONS:
                    raise self.fail(node, f"there is no function '{name}'")
                values = [self.value(a) for a in args]
                try:
                    return FUNCTIONS[name](*values)
                except TypeError as error:
                    raise self.fail(node, str(error)) from None
        raise self.fail(node, "this cannot be part of a formula")


def trace(function: str | Callable[..., Any], constants: dict[str, float], inputs: str = "xyz") -> tuple[Step, ...]:
    """The steps of a formula of these inputs, one letter each."""
    tape = _Tape()
    symbols = {name: tape.push("input", (), float(axis)) for axis, name in enumerate(inputs)}
    if isinstance(function, str):
        try:
            tree = ast.parse(function.strip(), mode="eval")
        except SyntaxError as error:
            raise ValueError(f"formula: {error.msg}\n  {function}") from None
        names: dict[str, Any] = {**symbols, "pi": math.pi, "e": math.e, **constants}
        result = _Reader(function.strip(), names).value(tree.body)
    else:
        result = function(*symbols.values(), **constants)
    index = tape.index(result)
    # The last step is the value.
    steps = tape.steps[: index + 1]
    return tuple(steps)


def _text(function: str | Callable[..., Any]) -> str:
    return repr(function) if isinstance(function, str) else getattr(function, "__name__", "callable")


class Formula(Object):
    """The surface where a function of x, y and z is zero; its inside is where the function is negative.

    Made by :func:`durer.formula`.

    Examples
    --------
    >>> import durer
    >>> durer.formula("x*x + y*y + z*z - 1", ball=((0, 0, 0), 2))
    formula('x*x + y*y + z*z - 1', ball=((0.0, 0.0, 0.0), 2.0))
    """

    __slots__ = ()

    def __init__(
        self,
        text: str,
        steps: tuple[Step, ...],
        threshold: float,
        box: tuple[Any, Any] | None,
        ball: tuple[Any, float] | None,
    ) -> None:
        native = _native.isosurface(
            [(name, list(operands), number) for name, operands, number in steps],
            threshold,
            None if box is None else [list(box[0]), list(box[1])],
            None if ball is None else (list(ball[0]), ball[1]),
        )
        self._set(native, (text, steps, threshold, box, ball))

    def __repr__(self) -> str:
        text, _, threshold, box, ball = self._arguments
        parts = [text]
        if threshold != 0.0:
            parts.append(f"threshold={threshold!r}")
        parts.append(f"ball={ball!r}" if box is None else f"box={box!r}")
        return f"formula({', '.join(parts)})"

    def __call__(self, x: float, y: float, z: float) -> float:
        """The value of the function at a point."""
        steps = [(name, list(operands), number) for name, operands, number in self._arguments[1]]
        return _native.formula_value(steps, [float(x), float(y), float(z)])


def formula(
    function: str | Callable[..., Any],
    *,
    box: tuple[Any, Any] | None = None,
    ball: tuple[Any, float] | None = None,
    threshold: float = 0.0,
    **constants: float,
) -> Formula:
    """The surface where ``function(x, y, z) == threshold``, as far as a box or a ball holds it.

    Parameters
    ----------
    function : str or callable
        A text such as ``"x*x + y*y - 1"`` or a callable of x, y and z. A callable is traced: it is called once with
        symbols, so it may use Python's operators and NumPy's functions, and ``durer.where`` in place of ``if``.
        Texts know ``sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp log log10 floor ceil trunc sqrt abs
        min max pow atan2 fmod mod hypot square where`` and ``pi`` and ``e``.
    box : pair of points, optional
        Two opposite corners of the container. Without a box or a ball: from (-10, -10, -10) to (10, 10, 10).
    ball : (point, float), optional
        Centre and radius of the container.
    threshold : float
        The value on the surface.
    **constants
        More names for the text, or keyword arguments of the callable.

    Returns
    -------
    Formula
        A solid: its inside is where the function is below the threshold. The container's own faces close it.

    Raises
    ------
    ValueError
        If the text cannot be read; it says where.

    Examples
    --------
    >>> import durer
    >>> rod = durer.formula("x*x + y*y - r**2", box=((-2, -2, -2), (2, 2, 2)), r=0.5)
    >>> rod
    formula('x*x + y*y - r**2', box=((-2.0, -2.0, -2.0), (2.0, 2.0, 2.0)))
    >>> hits = durer.Scene([rod]).closest([[-5, 0, 0]], [[1, 0, 0]])
    >>> float(hits.t[0])
    4.5
    >>> rod(1.0, 0.0, 0.0)
    0.75
    """
    steps = trace(function, {name: number(value, name) for name, value in constants.items()})
    text = _text(function)
    if box is None and ball is None:
        box = ((-10.0,) * 3, (10.0,) * 3)
    corners = None if box is None else (vector(box[0], "box"), vector(box[1], "box"))
    held = None if ball is None else (vector(ball[0], "ball"), number(ball[1], "ball"))
    return Formula(text, steps, number(threshold, "threshold"), corners, held)


class Parametric(Object):
    """The surface of three functions of u and v over a rectangle of parameters; an open surface.

    Made by :func:`durer.parametric`.

    Examples
    --------
    >>> import durer
    >>> sheet = durer.parametric("u", "v", "u*v", u=(0, 1), v=(0, 1))
    >>> isinstance(sheet, durer.Parametric)
    True
    """

    __slots__ = ()

    def __init__(
        self,
        texts: tuple[str, str, str],
        functions: tuple[tuple[Step, ...], ...],
        u: tuple[float, float],
        v: tuple[float, float],
        box: tuple[Any, Any] | None,
        ball: tuple[Any, float] | None,
    ) -> None:
        native = _native.parametric(
            [[(name, list(operands), value) for name, operands, value in steps] for steps in functions],
            [list(u), list(v)],
            None if box is None else [list(box[0]), list(box[1])],
            None if ball is None else (list(ball[0]), ball[1]),
        )
        self._set(native, (texts, functions, u, v, box, ball))

    def __repr__(self) -> str:
        texts, _, u, v, box, ball = self._arguments
        parts = [*texts, f"u={u!r}", f"v={v!r}"]
        if box is not None:
            parts.append(f"box={box!r}")
        if ball is not None:
            parts.append(f"ball={ball!r}")
        return f"parametric({', '.join(parts)})"


def parametric(
    x: str | Callable[..., Any],
    y: str | Callable[..., Any],
    z: str | Callable[..., Any],
    *,
    u: tuple[float, float],
    v: tuple[float, float],
    box: tuple[Any, Any] | None = None,
    ball: tuple[Any, float] | None = None,
    **constants: float,
) -> Parametric:
    """The surface of the points ``(x(u, v), y(u, v), z(u, v))``, met without tessellation.

    Parameters
    ----------
    x, y, z : str or callable
        Functions of u and v: texts or callables, as for :func:`durer.formula`.
    u, v : (float, float)
        From where to where the parameters go. Where the surface comes back to itself, as at 0 and 2 pi, a ray meets it once.
    box : pair of points, optional
        Two opposite corners; what is outside is cut off. Without a box or a ball the surface must be bounded.
    ball : (point, float), optional
        Centre and radius of a ball that cuts.
    **constants
        More names for the texts, or keyword arguments of the callables.

    Returns
    -------
    Parametric
        An open surface. Its texture coordinates are (u, v), its normal points along the cross product of its slopes.

    Raises
    ------
    ValueError
        If a text cannot be read, a domain does not ascend, a function jumps, or nothing is in the container.

    Examples
    --------
    >>> import math
    >>> import durer
    >>> turn = (0, 2 * math.pi)
    >>> ring = durer.parametric(
    ...     "(2 + r*cos(v)) * cos(u)", "(2 + r*cos(v)) * sin(u)", "r*sin(v)", u=turn, v=turn, r=0.5
    ... )
    >>> hits = durer.Scene([ring]).closest([[-5, 0, 0]], [[1, 0, 0]])
    >>> round(float(hits.t[0]), 12)
    2.5
    """
    values = {name: number(value, name) for name, value in constants.items()}
    functions = tuple(trace(function, values, "uv") for function in (x, y, z))
    corners = None if box is None else (vector(box[0], "box"), vector(box[1], "box"))
    held = None if ball is None else (vector(ball[0], "ball"), number(ball[1], "ball"))
    ends = [(number(a, name), number(b, name)) for name, (a, b) in (("u", u), ("v", v))]
    return Parametric((_text(x), _text(y), _text(z)), functions, ends[0], ends[1], corners, held)
