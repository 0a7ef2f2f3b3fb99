"""Frozen dataclasses that are made in a quarter of the time: every start makes 240 of them.

`dataclasses` compiles six methods for each frozen class. Here only `__init__` is compiled; the
others are the same functions for all classes. Whatever reads dataclasses reads these too.
"""

from __future__ import annotations

import dataclasses
from dataclasses import MISSING, FrozenInstanceError, asdict, astuple, field, fields, replace
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any

_PARAMS = "__dataclass_params__"
__all__ = ["asdict", "astuple", "dataclass", "field", "fields", "replace"]


def _dataclass(kind: Any = None, /, *, frozen: bool = False, **options: Any) -> Any:
    """As `dataclasses.dataclass`, without `InitVar`, order and the other rare options."""
    if not frozen:
        return dataclasses.dataclass(kind, **options)
    if kind is None:
        return partial(_dataclass, frozen=True, **options)
    methods: dict[str, Any] = {"__setattr__": _refuse, "__delattr__": _refuse}
    if options.get("slots"):
        methods["__setstate__"] = _restore
    if options.get("repr", True):
        methods["__repr__"] = _shown
    if options.get("eq", True):
        methods |= {"__eq__": _equal, "__hash__": _hash}
    bases = [vars(it).get(_PARAMS) for it in kind.__mro__[1:]]
    frozen_bases = [params for params in bases if params is not None and params.frozen]
    for params in frozen_bases:  # of which it must not be known in between
        params.frozen = False
    made: Any = dataclasses.dataclass(kind, **options | {"init": False, "repr": False, "eq": False})
    for params in (*frozen_bases, vars(made)[_PARAMS]):
        params.frozen = True  # so that frozen classes of the standard library may inherit from it
    methods["__init__"] = _init(made)
    for name in methods.keys() - vars(kind).keys():
        setattr(made, name, methods[name])
    if "__eq__" in methods:
        compared = {it.name: it.hash is not False for it in fields(made) if it.compare}
        made.__compared__ = attrgetter("__class__", *compared)
        made.__hashed__ = attrgetter("__class__", *filter(compared.get, compared))
    return made


if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    dataclass = _dataclass


def _refuse(self: Any, name: str, *value: object) -> None:
    raise FrozenInstanceError(f"cannot {'assign to' if value else 'delete'} field {name!r}")


def _restore(self: Any, state: Any) -> None:
    """What copies and pickles of classes with slots need."""
    for part in filter(None, state):
        for name, value in part.items():
            object.__setattr__(self, name, value)


def _shown(self: Any) -> str:
    values = (f"{it.name}={getattr(self, it.name)!r}" for it in fields(self) if it.repr)
    return f"{type(self).__qualname__}({', '.join(values)})"


def _equal(self: Any, other: Any) -> bool:
    same = type(other) is type(self)
    return self.__compared__(self) == self.__compared__(other) if same else NotImplemented


def _hash(self: Any) -> int:
    return hash(self.__hashed__(self))


def _init(kind: type) -> Any:
    scope: dict[str, Any] = {"_put": object.__setattr__}
    heads, lines = [], []
    for it in sorted(fields(kind), key=lambda item: bool(item.kw_only)):
        name, own = it.name, f"_of_{it.name}"
        head = value = name
        if it.default is not MISSING:
            scope[own], head = it.default, f"{name}={own}"
        elif it.default_factory is not MISSING:
            scope[own], head = it.default_factory, f"{name}={own}"
            value = f"{own}() if {name} is {own} else {name}"
        if it.init:
            heads += [*["*"] * bool(it.kw_only and "*" not in heads), head]
            lines.append(f"_put(self, {name!r}, {value})")
    if hasattr(kind, "__post_init__"):
        lines.append("self.__post_init__()")
    exec(f"def __init__(self, {', '.join(heads)}):\n " + ("; ".join(lines) or "pass"), scope)
    init = scope["__init__"]
    init.__annotations__ = {it.name: it.type for it in fields(kind) if it.init} | {"return": None}
    init.__qualname__ = f"{kind.__qualname__}.__init__"
    return init
