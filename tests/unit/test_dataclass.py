"""Our dataclasses are those of the standard library, made faster."""

import copy
import dataclasses
import inspect
import pickle

import pytest

from epicyclic import dataclass as ours
from epicyclic.dataclass import dataclass, field

FORMS = {
    "slots": {"slots": True},
    "dict": {},
    "keywords": {"slots": True, "kw_only": True},
    "without eq": {"slots": True, "eq": False},
    "without repr": {"repr": False},
}


class _Body:
    first: int
    second: list[int] = field(default_factory=list, hash=False)
    third: str = "c"
    beside: float = field(default=4.5, compare=False, kw_only=True)
    hidden: int = field(default=6, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "first", 10 * self.first)


def made(decorator, options):
    body = dict(vars(_Body), __module__=__name__, __qualname__="Made")
    del body["__dict__"], body["__weakref__"]
    kind = decorator(frozen=True, **options)(type("Made", (), body))
    globals()["Made"] = kind  # where pickle looks for it
    return kind


@pytest.mark.parametrize("options", FORMS.values(), ids=FORMS)
def test_classes_behave_as_those_of_the_standard_library(options):
    def said(decorator):
        kind = made(decorator, options)
        one, other = kind(first=1, second=[2]), kind(first=1, second=[2], beside=9.0)
        changed = dataclasses.replace(one, first=3, third="x")
        yield str(inspect.signature(kind)).replace("<factory>", "<class 'list'>")
        yield kind.__match_args__
        yield one == other, one == changed, one != "a", one == copy.deepcopy(one)
        yield dataclasses.astuple(one), dataclasses.astuple(changed), dataclasses.asdict(other)
        yield dataclasses.astuple(pickle.loads(pickle.dumps(changed))), hasattr(one, "__dict__")
        if options.get("repr", True):
            yield repr(one)
        if options.get("eq", True):
            yield hash(one) == hash(other), hash(one) == hash(changed)
        for act in (lambda: setattr(one, "first", 2), lambda: delattr(one, "third"), kind):
            with pytest.raises((dataclasses.FrozenInstanceError, TypeError)) as error:
                act()
            yield type(error.value), str(error.value).replace("Made.", "")

    assert list(said(dataclass)) == list(said(dataclasses.dataclass))


def test_what_a_class_says_itself_stays():
    @dataclass(frozen=True, slots=True)
    class Own:
        value: float

        def __repr__(self):
            return "own"

        def __hash__(self):
            return 7

    assert (repr(Own(1.5)), hash(Own(1.5))) == ("own", 7)
    assert Own(1.5) == Own(1.5)


def test_classes_of_the_standard_library_may_inherit_and_ours_from_them():
    @dataclass(frozen=True, slots=True)
    class First:
        one: float

    @dataclasses.dataclass(frozen=True)
    class Second(First):
        two: float = 2.5

    @dataclass(frozen=True, slots=True)
    class Third(Second):
        three: float = 3.5

    third = Third(1.5)
    assert dataclasses.astuple(third) == (1.5, 2.5, 3.5)
    assert third == Third(1.5, 2.5) != Third(1.0)
    assert hash(Second(1.5)) == hash(Second(1.5, 2.5))
    for value in (First(1.5), Second(1.5), third):
        with pytest.raises(dataclasses.FrozenInstanceError):
            value.one = 2.0


def test_other_classes_are_left_to_the_standard_library():
    @dataclass
    class Free:
        value: float = 1.5

    one = Free()
    one.value = 2.5
    assert one == Free(2.5)
    assert ours.replace is dataclasses.replace
