"""Losses that the solver foretells in place of asking an element again."""

from __future__ import annotations

from dataclasses import replace

import pytest

import epicyclic as ep
from epicyclic.arrays import of_points
from epicyclic.build.machine import build
from epicyclic.machine import gear_set
from epicyclic.machine.element import LOAD_DEPENDENT, ElementResult, Loss, State
from epicyclic.machine.solve import LOSS_AGREEMENT, NEAR, Answer, _answered, lossless_state


def result(watts, mesh="S.mesh"):
    return ElementResult({"sliding": Loss(LOAD_DEPENDENT, watts, mesh=mesh)})


def losses(load):
    """Of a mesh: a little more than proportional to the load."""
    return result(0.01 * abs(load) ** 1.2)


def after(answer, loads, result, serve=()):
    """The answer that comes next, as the solver makes it."""
    return answer.then(loads, result, frozenset(serve))


def foretold(answer, loads, allowed):
    """What the element would answer; None if it has to be asked."""
    losses, serve = answer.predicted(loads, allowed)
    return ElementResult(losses) if serve >= loads.keys() else None


def answers(*loads):
    """The answers to one load after the other."""
    first, *others = loads
    answer = Answer({"mesh": first}, losses(first))
    for load in others:
        answer = after(answer, {"mesh": load}, losses(load))
    return answer


def test_one_answer_serves_for_loads_next_to_its_own():
    answer = answers(100.0)
    near = foretold(answer, {"mesh": 100.0000005}, 1e-7)
    assert near is not None
    assert near.losses == answer.result.losses
    assert foretold(answer, {"mesh": 100.0001}, 1e-7) is None


def test_what_is_predicted_is_as_near_as_was_allowed():
    answer = answers(100.0, 99.0, 99.01)
    told = foretold(answer, {"mesh": 99.0101}, 1e-6)
    assert told is not None
    wanted = losses(99.0101).losses["sliding"].watts
    assert told.losses["sliding"].watts == pytest.approx(wanted, rel=1e-7)
    assert foretold(answer, {"mesh": 99.0101}, 1e-12) is None
    assert foretold(answer, {"mesh": 80.0}, 1e-6) is None


def test_a_kink_is_not_foretold():
    """Where the line did not foretell the last answer, it is not trusted with the next."""
    answer = after(answers(100.0, 99.0), {"mesh": 98.9}, result(5.0))
    assert foretold(answer, {"mesh": 98.8999}, 1e-6) is None


def test_what_scatters_is_foretold_within_its_scatter():
    """Two answers to nearly the same load differ by more than the load explains."""
    answer = after(answers(100.0, 99.0), {"mesh": 99.0 * (1 + 1e-11)}, result(2.48 + 1.24e-9))
    answer = after(answer, {"mesh": 99.0 * (1 + 2e-11)}, result(2.48))
    load = {"mesh": 99.0 * (1 + 3e-11)}
    assert foretold(answer, load, 0.4e-9) is None  # less than the scatter of 5e-10, doubled
    told = foretold(answer, load, 1.2e-9)
    assert told.losses["sliding"].watts == pytest.approx(2.48, rel=1.2e-9)


@pytest.mark.parametrize(
    ("load", "mesh"), [(-98.9, "S.mesh"), (98.9, "")], ids=["other direction", "other place"]
)
def test_another_direction_or_place_starts_anew(load, mesh):
    answer = after(answers(100.0, 99.0), {"mesh": load}, result(1.0, mesh))
    assert answer.before.loads == answer.loads
    assert answer.before.result.losses == answer.result.losses
    assert foretold(answer, {"mesh": load * 1.0001}, 1e9) is None


def test_of_several_points_those_that_turn_start_anew():
    first, second = (of_points([[load], [other]]) for load, other in ((100, 97), (99, -96)))
    answer = after(Answer({"mesh": first}, losses(first)), {"mesh": second}, losses(second))
    assert answer.before.loads["mesh"].ravel().tolist() == [100.0, -96.0]
    watts = [losses(load).losses["sliding"].watts for load in (100.0, 96.0)]
    assert answer.before.result.losses["sliding"].watts.ravel() == pytest.approx(watts, rel=1e-14)


def test_a_planet_pressed_inward_and_then_outward_is_as_before():
    built = build(ep.load_case("talbot-2012").updated({"operation.speed": "120 rpm"}))
    state = lossless_state(built.machine, built.operation, built.fluids)
    (own,) = built.sets.values()
    (planet,) = own.planets
    loads, pressed = [], []
    for share in (0.99, 1.01):
        ring = share * state.torques[".ring_mesh"]
        its = replace(state, torques={**state.torques, ".ring_mesh": ring})
        duties = {duty.gears.key: duty for duty in own.mean_duties(its)}
        pressed.append(planet.force(duties, its.speeds[own.carrier]).imag)
        loads.append(own.loads(its))
    assert pressed[0] * pressed[1] < 0
    assert Answer(loads[0], result(1.0)).alike(loads[1], result(1.0))


def test_an_element_is_asked_again_where_its_own_gears_drive_the_other_way():
    class Own:
        key = "S"
        asked = 0

        def loads(self, state, last=None):
            return state.torques

        def evaluate(self, state, last=None):
            self.asked += 1
            return losses(state.torques["S.mesh"])

    element, known = Own(), None
    for own, other, asked in ((True, True, 1), (True, False, 1), (False, False, 2)):
        drives = {"S.mesh": own, "T.mesh": other}
        state = State({}, {"S.mesh": 70.0}, {}, None, drives=drives)
        known = _answered(element, state, known, LOSS_AGREEMENT)
        assert element.asked == asked


def test_loads_beside_the_line_are_not_foretold():
    answer = Answer({"one": 100.0, "two": 50.0}, result(1.0))
    answer = after(answer, {"one": 99.0, "two": 49.5}, result(0.99))
    answer = after(answer, {"one": 98.9, "two": 49.45}, result(0.989))
    assert foretold(answer, {"one": 98.898, "two": 49.449}, 1e-6) is not None
    assert foretold(answer, {"one": 98.898, "two": 49.4505}, 1e-6) is None


def own(name, load):
    """Two meshes of one element, each with the loss of its own load."""
    watts = {"one": 0.01, "two": 0.02}[name] * load**1.1
    return Loss(LOAD_DEPENDENT, watts, mesh=f"S.{name}", follows=(name,))


def both(one, two):
    return {"one": one, "two": two}, ElementResult({"one": own("one", one), "two": own("two", two)})


def test_a_loss_that_follows_one_load_is_foretold_beside_the_line_of_all():
    answer = after(Answer(*both(100.0, 50.0)), *both(99.9, 49.8))
    loads, wanted = both(99.9001, 49.8007)
    told = foretold(answer, loads, 1e-6)
    assert told is not None
    for name, loss in wanted.losses.items():
        assert told.losses[name].watts == pytest.approx(loss.watts, rel=5e-9)
    joint = after(Answer(loads, losses(1.0)), both(99.9, 49.8)[0], losses(1.001))
    assert foretold(joint, both(99.9001, 49.7993)[0], 1e-6) is None


def test_figures_serve_for_loads_next_to_theirs_only():
    answer = answers(100.0, 99.9)
    assert foretold(answer, {"mesh": 99.9 * (1 + 0.9 * NEAR)}, 1.0) is not None
    assert foretold(answer, {"mesh": 99.9 * (1 + 1.1 * NEAR)}, 1.0) is None


def test_a_load_that_did_not_move_before_foretells_little():
    answer = after(Answer(*both(100.0, 50.0)), *both(99.9, 50.0))
    assert foretold(answer, both(99.9, 50.0001)[0], 1e-6) is None
    assert foretold(answer, both(99.9001, 50.0)[0], 1e-6) is not None


def test_only_what_is_not_foretold_is_asked_again():
    """The load of the other mesh is still the one that its loss belongs to."""
    answer = after(Answer(*both(100.0, 50.0)), *both(99.9, 49.8))
    loads, wanted = both(99.9001, 49.7)
    losses, serve = answer.predicted(loads, 1e-6)
    assert serve == {"one"}
    assert losses["one"].watts == pytest.approx(wanted.losses["one"].watts, rel=5e-9)
    mixed = ElementResult({"one": own("one", 99.9), "two": own("two", 49.7)})
    after_it = after(answer, loads, mixed, serve)
    assert after_it.loads == {"one": 99.9, "two": 49.7}
    assert after_it.before.loads == {"one": 100.0, "two": 49.8}
    assert after_it.before.result.losses == both(100.0, 49.8)[1].losses
    told = foretold(after_it, both(99.9002, 49.7001)[0], 1e-6)
    for name, loss in both(99.9002, 49.7001)[1].losses.items():
        assert told.losses[name].watts == pytest.approx(loss.watts, rel=5e-8)


@pytest.mark.parametrize("torque", ["-700 N*m", "-3 N*m", "90 N*m", "800 N*m"])
def test_losses_are_those_of_elements_that_are_always_asked(torque, monkeypatch):
    case = ep.load_case("talbot-2012").updated({"operation.torque": torque})
    asked = []
    solve_mesh = gear_set.solve_mesh
    monkeypatch.setattr(gear_set, "solve_mesh", lambda *args: asked.append(1) or solve_mesh(*args))
    losses, few = ep.solve(case).losses, len(asked)
    predicted = Answer.predicted
    monkeypatch.setattr(Answer, "predicted", lambda *args: (predicted(*args)[0], frozenset()))
    whole = ep.solve(case)
    assert few < len(asked) - few
    for name, watts in whole.losses.items():
        assert losses[name] == pytest.approx(watts, abs=LOSS_AGREEMENT * whole.total)
