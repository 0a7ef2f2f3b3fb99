"""The power flow of a train: sets as columns, shafts as lines, arrows as wide as the power."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import pairwise, permutations
from typing import Any

from matplotlib.axes import Axes
from matplotlib.patches import FancyBboxPatch, Polygon, Rectangle

from epicyclic.dataclass import dataclass, replace
from epicyclic.result.result import Result
from epicyclic.show.page import shown
from epicyclic.show.plots.style import COLOURS
from epicyclic.show.power_flow import NO_POWER, Line, Link, TrainFlow, power_flow
from epicyclic.units import RPM, known_text, percent, torque_text, unit_text

# Shapes that the slides of power and of heat have in common. Every length is in inches.

INK, SOFT = "#1a1d21", "#5b6470"  # Colours of words and of edges.
_ROUND = 0.04  # Radius of the corners of a box.


@dataclass(frozen=True, slots=True)
class Arrow:
    """How heads of arrows follow from widths."""

    # Half the width of a head, and its length: at least, and over the width of the arrow.
    reach: tuple[float, float]
    length: tuple[float, float]
    share: float  # Of the arrow, for the head at most.

    def corners(
        self, start: float, tip: float, middle: float, width: float, *, upright: bool = False
    ) -> list[tuple[float, float]]:
        """Of an arrow to the right or left, or upright."""
        half = width / 2
        reach, length = (max(least, over * width) for least, over in (self.reach, self.length))
        length = min(self.share * abs(tip - start), length)
        neck = tip - length if tip > start else tip + length
        below = [(start, middle - half), (neck, middle - half), (neck, middle - reach)]
        above = [(neck, middle + reach), (neck, middle + half), (start, middle + half)]
        points = [*below, (tip, middle), *above]
        return [(across, along) for along, across in points] if upright else points


def draw_box(
    ax: Axes, corner: tuple[float, float], size: tuple[float, float], **style: Any
) -> None:
    """A box with round corners, behind words."""
    place = corner[0] + _ROUND, corner[1] + _ROUND
    sides = size[0] - 2 * _ROUND, size[1] - 2 * _ROUND
    shape = f"round,pad={_ROUND}"
    ax.add_patch(FancyBboxPatch(place, *sides, shape, ec=SOFT, lw=0.9, zorder=5, **style))


def fit(letter: float, text: str, room: float, size: float) -> float:
    """The size of a font at which `text` fits into `room`; `letter` is in inch/point. [point]"""
    return min(size, room / (letter * max(1, len(text))))


# Every length is in inches on a slide of 16 to 9.

SLIDE = (13.33, 7.5)  # Width and height. [inch]
THROUGH, CIRCULATING, LOST = COLOURS[0], COLOURS[4], COLOURS[1]
DARK = "#8a5f00"  # The colour of circulating power, for words.
STRIPE, BOX = "#f2f4f7", "#e3e8ee"
LABELS, RIGHT_END = 2.55, 1.55
"""Room for the names of shafts at the left, and for the output at the right."""
TOP, LOWEST, GROUNDS, LEGEND = 6.85, 1.75, 1.45, 0.25
"""Upper edge of the cards of the sets; lower edge of the shafts; brakes; legend."""
HEAD, ROW = 0.36, 0.24  # Heights of the name on a card, and of each of its meshes.
CHARACTER, WORDS = 0.0085, 0.75
"""Width of a character, and part of a card for words beside its bars at most. [inch/point, 1]"""
WIDEST, THINNEST, SHORTEST = 0.6, 0.02, 0.55
"""Widths of arrows, whatever the power; length below which they have no label."""
MOST_ORDERED = 6  # Sets, and shafts, of which all orders are compared.
_ARROW = Arrow(reach=(0.09, 0.5), length=(0.16, 0.5), share=0.5)
_fit = partial(fit, CHARACTER)
_box = partial(draw_box, fc=BOX)
_LABEL: Any = {"ha": "center", "fontsize": 11, "zorder": 6}


@dataclass(frozen=True, slots=True)
class _Layout:
    """What is drawn where."""

    flow: TrainFlow
    columns: Mapping[str, float]  # x of each set.
    lanes: Mapping[str, float]  # y of each line that passes power.
    taps: Mapping[str, float]  # Losses of bearings, seals and drags by their line. [W]
    width: float  # Of a column.
    spacing: float  # Of the lanes.
    scale: float = 0.0  # Width of an arrow over its power. [inch/W]

    @property
    def box(self) -> float:
        """Half the width of a box."""
        return min(0.62, 0.3 * self.width)

    @property
    def height(self) -> float:
        """Half the height of a box."""
        return min(0.36, 0.4 * self.spacing)

    def crossing(self, stage: str) -> list[Link]:
        """The links of a set with lines that pass power, from the lowest one upwards."""
        links = [link for link in self.flow.of_stage(stage) if link.line in self.lanes]
        return sorted(links, key=lambda link: self.lanes[link.line])

    def grounds(self, stage: str) -> list[Link]:
        """The links of a set with what stands still and holds it."""
        links = [link for link in self.flow.of_stage(stage) if link.line not in self.lanes]
        most = max((abs(link.torque) for link in self.flow.of_stage(stage)), default=0.0)
        return [link for link in links if link.members and abs(link.torque) > NO_POWER * most]


def plot_power_flow(result: Result, ax: Axes) -> Axes:
    """Which power each set takes from which shaft, what circulates, what is lost where."""
    flow = power_flow(result)
    ax.set_axis_off()
    ax.set(xlim=(0, SLIDE[0]), ylim=(0, SLIDE[1]))
    ax.set_title(f"Power flow: {_headline(result)}", fontsize=13, x=0.008)
    layout = _layout(flow)
    for number, (key, y) in enumerate(sorted(layout.lanes.items(), key=lambda item: -item[1])):
        _draw_lane(ax, layout, flow.lines[key], y, striped=number % 2 == 0)
    for stage, x in layout.columns.items():
        _draw_spine(ax, layout, stage, x)
    for key, y in layout.lanes.items():
        _draw_line(ax, layout, flow.lines[key], y)
    for stage, x in layout.columns.items():
        _draw_boxes(ax, layout, stage, x)
        _draw_card(ax, layout, stage, x, result.input_power)
        _draw_grounds(ax, layout, stage, x)
    _draw_legend(ax, layout, result.input_power)
    return ax


def _headline(result: Result) -> str:
    train = result.train
    words = [f"state {train.state}"] if train and train.state else []
    if train and train.ratio is not None:
        words.append(f"ratio {shown(train.ratio)}")
    if result.efficiency is not None:
        words.append(f"efficiency {100 * result.efficiency:.2f} %")
    words.append(f"loss {_power(result.total)}")
    if train and train.power_ratio is not None:
        words.append(f"rolling power {shown(train.power_ratio, 3)} times the input power")
    if train and train.self_locking:
        words.append("self-locking")
    return ", ".join(words)


def _power(watts: float) -> str:
    return known_text(abs(watts))


def _torque(value: float) -> str:
    return torque_text(0.0 if abs(value) < NO_POWER else abs(value), 4)


def _layout(flow: TrainFlow) -> _Layout:
    most = max((abs(link.power) for link in flow.links), default=0.0)
    busy = {link.line for link in flow.links if abs(link.power) > NO_POWER * most}
    ends = ("input", "output")
    lines = [key for key, line in flow.lines.items() if key in busy or line.role in ends]
    stages: list[str] = []
    taps: defaultdict[str, float] = defaultdict(float)
    for stage in flow.stages:
        links = [link for link in flow.of_stage(stage) if link.line in lines]
        if not any(link.members for link in links) and len(links) == 1:
            taps[links[0].line] += flow.stages[stage].loss
        elif any(abs(link.power) > NO_POWER * most for link in links):
            stages.append(stage)
    stages = _ordered_stages(flow, stages, lines)
    lines = _ordered_lines(flow, stages, lines)
    width = (SLIDE[0] - LABELS - RIGHT_END) / max(1, len(stages))
    rows = max((len(flow.stages[key].rolling) for key in stages), default=0)
    highest = TOP - HEAD - ROW * rows - 0.2
    spacing = (highest - LOWEST) / max(1, len(lines))
    columns = {key: LABELS + (number + 0.5) * width for number, key in enumerate(stages)}
    lanes = {key: highest - (number + 0.5) * spacing for number, key in enumerate(lines)}
    drawn = _Layout(flow, columns, lanes, taps, width, spacing)
    pieces = [piece for key in lanes for piece in _pieces(drawn, flow.lines[key])]
    pieces += [piece for key in columns for piece in _rises(drawn, key)]
    widest = max((abs(one.through) + abs(one.circulating) for one in pieces), default=0.0)
    return replace(drawn, scale=min(WIDEST, 0.45 * spacing) / widest if widest else 0.0)


def _ordered_stages(flow: TrainFlow, stages: list[str], lines: list[str]) -> list[str]:
    """Sets in the order of the power, with short lines between them."""
    ends = {key: line.power for key, line in flow.lines.items() if line.power}
    links = {key: [link for link in flow.of_line(key) if link.stage in stages] for key in lines}

    def effort(order: tuple[str, ...]) -> float:
        place = {key: number for number, key in enumerate(order)}
        total = 0.0
        for key in lines:
            own = [(place[link.stage], link.power) for link in links[key]]
            if not own:
                continue
            places = [at for at, _ in own]
            left = -1 if ends.get(key, 0.0) > 0 else min(places)
            right = len(order) if ends.get(key, 0.0) < 0 else max(places)
            total += right - left
            total += sum(
                0.6 for at, power in own for to, more in own if power < 0 < more and to < at
            )
        return total

    return _in_best_order(stages, effort)


def _in_best_order(names: list[str], effort: Callable[[tuple[str, ...]], float]) -> list[str]:
    """The order of least effort; of many names that which they have."""
    if len(names) > MOST_ORDERED:
        return names
    best: tuple[str, ...] = min(permutations(names), key=effort)
    return list(best)


def _ordered_lines(flow: TrainFlow, stages: list[str], lines: list[str]) -> list[str]:
    """Lines so that those of one set lie beside each other, the input on top."""
    joined = [
        [link.line for link in flow.of_stage(stage) if link.line in lines] for stage in stages
    ]

    def effort(order: tuple[str, ...]) -> float:
        place = {key: number for number, key in enumerate(order)}
        total = 0.0
        for own in joined:
            places = [place[key] for key in own]
            total += max(places) - min(places)
        for key in lines:
            if flow.lines[key].role == "input":
                total += 0.4 * place[key]
            elif flow.lines[key].role == "output":
                total -= 0.4 * place[key]
        return total

    return _in_best_order(lines, effort)


@dataclass(frozen=True, slots=True)
class _Piece:
    """Power from `start` to `end`, positive to the right or upwards."""

    start: float
    end: float
    through: float
    circulating: float


def _pieces(layout: _Layout, line: Line) -> Iterator[_Piece]:
    """The power on a line from place to place.

    Bearings and seals take theirs where it enters, at the output where it leaves.
    """
    marks = _marks(layout, line)
    through = circulating = 0.0
    for (left, power, loops), (right, *_) in pairwise(marks):
        through += power - loops
        circulating += loops
        if right == SLIDE[0] - RIGHT_END:
            through = -line.power - circulating
        # what loops leave over where they end is rounding
        flows = (through, circulating)
        whole = max((abs(mark[1]) for mark in marks), default=0.0)
        through, circulating = (0.0 if abs(one) <= NO_POWER * whole else one for one in flows)
        yield _Piece(left, right, through, circulating)


def _rises(layout: _Layout, stage: str) -> Iterator[_Piece]:
    """The power inside a set from line to line, upwards."""
    through = circulating = 0.0
    for below, above in pairwise(layout.crossing(stage)):
        through += below.power - below.circulating
        circulating += below.circulating
        yield _Piece(layout.lanes[below.line], layout.lanes[above.line], through, circulating)


def _marks(layout: _Layout, line: Line) -> list[tuple[float, float, float]]:
    """Where power enters a line: place, power, and how much of it circulates."""
    marks = [
        (layout.columns[link.stage], -link.power, -link.circulating)
        for link in layout.flow.of_line(line.key)
        if link.stage in layout.columns
    ]
    if line.role == "input":
        marks.append((LABELS - 0.15, line.power, 0.0))
    elif line.power or line.role == "output":
        marks.append((SLIDE[0] - RIGHT_END, line.power, 0.0))
    return sorted(marks)


def _draw_lane(ax: Axes, layout: _Layout, line: Line, y: float, *, striped: bool) -> None:
    """Stripe and name of a line."""
    if striped:
        low = y - layout.spacing / 2
        ax.add_patch(Rectangle((0, low), SLIDE[0], layout.spacing, color=STRIPE, lw=0, zorder=0))
    words = [f"{shown(RPM.to_display(line.speed))} {unit_text(RPM.display)}", _torque(line.passed)]
    lower = ", ".join(words)
    name = " + ".join(name.replace("_", " ") for name in line.shafts)
    size = 13.0 if len(name) <= 19 else 13.0 * 19 / len(name)
    up = 0.02 if not line.clutches else 0.08
    ax.text(0.1, y + up, name, fontsize=size, fontweight="bold", va="bottom", color=INK)
    ax.text(0.1, y + up - 0.03, lower, fontsize=11, va="top", color=INK)
    if line.clutches:
        torques = ", ".join(_torque(torque) for torque in line.clutches.values())
        word = "clutch" if len(line.clutches) == 1 else "clutches"
        ax.text(0.1, y + up - 0.23, f"{word} {torques}", fontsize=9.5, va="top", color=SOFT)
    marks = _marks(layout, line)
    if marks and marks[0][0] > LABELS:
        ax.add_patch(Rectangle((LABELS - 0.15, y), marks[0][0] - LABELS + 0.15, 0.0, ec="0.75"))


def _draw_line(ax: Axes, layout: _Layout, line: Line, y: float) -> None:
    sets, pieces = layout.columns.values(), list(_pieces(layout, line))
    for piece in pieces:  # from box to box of the sets of this line
        left = piece.start + (layout.box if piece.start in sets else 0.0)
        right = piece.end - (layout.box if piece.end in sets else 0.0)
        crossed = [x for x in sets if left < x < right]
        whole = sum(_widths(layout, piece))
        if crossed and whole:
            low, height = y - whole / 2 - 0.06, whole + 0.12
            bridge = Rectangle((left, low), right - left, height, color="white", lw=0, zorder=3)
            ax.add_patch(bridge)
        _draw_band(ax, layout, replace(piece, start=left, end=right), y)
        # words stand in the longest part that no other set crosses
        start, end = max(
            pairwise([left, *sorted(crossed), right]), key=lambda part: round(part[1] - part[0], 3)
        )
        if end - start > SHORTEST:
            _label_band(ax, piece, (start + end) / 2, y, whole / 2)
    if line.key in layout.taps and pieces:
        piece = pieces[-1] if line.role == "output" else pieces[0]
        # amid the piece as far as the first set that it passes
        after = min(x for x in (*sets, piece.end) if x > piece.start)
        x, edge = (piece.start + after) / 2, y - sum(_widths(layout, piece)) / 2
        _draw_loss(ax, (x, edge), edge - 0.28, THINNEST)
        style: Any = {"va": "center", "fontsize": 10, "color": LOST, "zorder": 6}
        ax.text(x + 0.12, edge - 0.16, _power(layout.taps[line.key]), **style)


def _widths(layout: _Layout, piece: _Piece) -> tuple[float, float]:
    """Widths of the power that passes through and of what circulates."""
    through, circulating = (
        max(THINNEST, abs(power) * layout.scale) if power else 0.0
        for power in (piece.through, piece.circulating)
    )
    return through, circulating


def _draw_band(
    ax: Axes, layout: _Layout, piece: _Piece, middle: float, *, upright: bool = False
) -> None:
    """What passes through and what circulates, side by side."""
    widths = _widths(layout, piece)
    edge = middle + sum(widths) / 2
    zorder = 2.5 if upright else 4
    for power, width, colour in zip(
        (piece.through, piece.circulating), widths, (THROUGH, CIRCULATING), strict=True
    ):
        if width:
            ends = (piece.start, piece.end) if power > 0 else (piece.end, piece.start)
            points = _ARROW.corners(*ends, edge - width / 2, width, upright=upright)
            ax.add_patch(Polygon(points, closed=True, color=colour, lw=0, zorder=zorder))
            edge -= width


def _label_band(ax: Axes, piece: _Piece, x: float, y: float, half: float) -> None:
    """Powers above and below a band."""
    if piece.through:
        ax.text(x, y + half + 0.07, _power(piece.through), va="bottom", color=THROUGH, **_LABEL)
    if piece.circulating:
        ax.text(x, y - half - 0.07, _power(piece.circulating), va="top", color=DARK, **_LABEL)


def _draw_loss(ax: Axes, start: tuple[float, float], tip: float, width: float) -> None:
    x, y = start
    points = _ARROW.corners(y, tip, x, width, upright=True)
    ax.add_patch(Polygon(points, closed=True, color=LOST, lw=0, zorder=3.5))


def _draw_spine(ax: Axes, layout: _Layout, stage: str, x: float) -> None:
    """What joins the boxes of a set to its card and its brakes, and the power within it."""
    links = layout.crossing(stage)
    lowest = GROUNDS if layout.grounds(stage) else layout.lanes[links[0].line]
    spine = Rectangle((x - 0.11, lowest), 0.22, TOP - HEAD - lowest, color=BOX, lw=0, zorder=2)
    ax.add_patch(spine)
    for piece in _rises(layout, stage):
        within = replace(piece, start=piece.start + layout.height, end=piece.end - layout.height)
        _draw_band(ax, layout, within, x, upright=True)
    loss = layout.flow.stages[stage].loss
    if loss:
        width = max(THINNEST, loss * layout.scale)
        highest = layout.lanes[links[-1].line]
        ax.add_patch(
            Rectangle((x - width / 2, highest), width, TOP - highest, color=LOST, lw=0, zorder=2.5)
        )
        _draw_loss(ax, (x, TOP), TOP + 0.4, width)


def _draw_boxes(ax: Axes, layout: _Layout, stage: str, x: float) -> None:
    """One box for each line of a set, with its members and their torque."""
    room = 2 * layout.box
    write = partial(ax.text, x, ha="center", zorder=7)
    for link in layout.crossing(stage):
        y = layout.lanes[link.line]
        _box(ax, (x - layout.box, y - layout.height), (room, 2 * layout.height))
        name = " + ".join(member.replace("_", " ") for member in link.members)
        write(y + 0.02, name, va="bottom", fontsize=_fit(name, room, 11), color=INK)
        torque = _torque(link.torque)
        write(y - 0.02, torque, va="top", fontsize=_fit(torque, room, 10), color=SOFT)


def _draw_card(ax: Axes, layout: _Layout, stage: str, x: float, entering: float) -> None:
    """Name of a set, the rolling power of its meshes, its loss."""
    own = layout.flow.stages[stage]
    rows = len(own.rolling)
    half = min(1.7, 0.5 * layout.width - 0.08)
    height = HEAD + ROW * rows
    _box(ax, (x - half, TOP - height), (2 * half, height))
    write = partial(ax.text, color=INK, zorder=7)
    name = stage.replace("_", " ")
    size = _fit(name, 2 * half, 13)
    write(x, TOP - 0.06, name, ha="center", va="top", fontsize=size, fontweight="bold")
    most = max(
        (abs(power) for each in layout.flow.stages.values() for power in each.rolling.values()),
        default=0.0,
    )
    room = 2 * half - 0.16
    names = [mesh.removesuffix("_mesh").replace("_", " ") for mesh in own.rolling]
    powers = [_power(power) for power in own.rolling.values()]
    longest = [max(map(len, column), default=0) + 2 for column in (names, powers)]
    size = min(10, WORDS * room / (CHARACTER * sum(longest)))
    before, after = (CHARACTER * size * count for count in longest)
    left = x - half + 0.08 + before  # words stand beside the bars, whose ends would cross them
    scale = (room - before - after) / max(most, entering) if rows else 0.0
    for number, (words, power) in enumerate(zip(names, own.rolling.values(), strict=True)):
        low = TOP - HEAD - ROW * (number + 1) + 0.04
        inside = min(abs(power), entering) * scale
        for start, length, colour in (
            (0.0, inside, THROUGH),
            (inside, abs(power) * scale - inside, CIRCULATING),
        ):
            at = left + start, low
            ax.add_patch(Rectangle(at, length, 0.19, color=colour, alpha=0.35, lw=0, zorder=6))
        write(x - half + 0.08, low + 0.09, words, va="center", fontsize=size)
        write(x + half - 0.08, low + 0.09, _power(power), ha="right", va="center", fontsize=size)
    if own.loss:
        share = f" ({percent(own.loss / entering, 2)})" if entering else ""
        aside = x + 0.14 + own.loss * layout.scale / 2
        lost = f"{_power(own.loss)}{share}"
        ax.text(aside, TOP + 0.26, lost, va="center", fontsize=11, color=LOST)


def _draw_grounds(ax: Axes, layout: _Layout, stage: str, x: float) -> None:
    """What is held, as ground, with the torque that holds it."""
    grounds = layout.grounds(stage)
    room = layout.width / max(1, len(grounds))
    step = min(1.25, room)
    for number, link in enumerate(grounds):
        at = x + (number - (len(grounds) - 1) / 2) * step
        if len(grounds) > 1:
            corner = min(x, at), GROUNDS - 0.03
            ax.add_patch(Rectangle(corner, abs(at - x), 0.06, color=BOX, zorder=2))
        ax.add_patch(Rectangle((at - 0.03, GROUNDS - 0.22), 0.06, 0.22, color=INK, lw=0, zorder=3))
        ax.add_patch(Rectangle((at - 0.26, GROUNDS - 0.25), 0.52, 0.04, color=INK, lw=0, zorder=3))
        for stroke in range(5):
            right = at - 0.2 + 0.11 * stroke
            ends = [(right, GROUNDS - 0.25), (right - 0.1, GROUNDS - 0.37)]
            ax.add_patch(Polygon(ends, closed=False, ec=INK, fill=False, lw=1.1))
        member = " + ".join(name.replace("_", " ") for name in link.members)
        held = link.line.replace("_", " ")
        name = member if held in (member, f"{stage}.{member}") else f"{member}, {held}"
        for low, words, colour in ((0.42, name, INK), (0.6, _torque(link.torque), SOFT)):
            size = _fit(words, room, 10)
            ax.text(at, GROUNDS - low, words, ha="center", va="top", fontsize=size, color=colour)


def _draw_legend(ax: Axes, layout: _Layout, entering: float) -> None:
    flow = layout.flow
    rolling = [abs(power) for stage in flow.stages.values() for power in stage.rolling.values()]
    entries = [("power from shaft to shaft", THROUGH), ("loss", LOST)]
    beyond = max(rolling, default=0.0) > entering > 0
    if flow.circulating or beyond:
        entries.insert(1, ("circulating power", CIRCULATING))
    x = 0.1
    for words, colour in entries:
        ax.add_patch(Rectangle((x, LEGEND + 0.1), 0.3, 0.16, color=colour, lw=0))
        ax.text(x + 0.38, LEGEND + 0.18, words, va="center", fontsize=10, color=INK)
        x += 0.6 + 0.085 * len(words)
    notes = []
    if rolling:
        bars = "bars: rolling power of the meshes"
        notes.append(f"{bars}, orange above the input power" if beyond else bars)
    if layout.taps:
        notes.append("below the shafts: bearings, seals, drags")
    idle = [
        key.replace("_", " ")
        for key, stage in flow.stages.items()
        if stage.rolling and key not in layout.columns
    ]
    if idle:
        notes.append(f"without power: {', '.join(idle)}")
    ax.text(0.1, LEGEND - 0.12, "; ".join(notes), va="center", fontsize=10, color=SOFT)
