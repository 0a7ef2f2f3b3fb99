"use strict";
// The explorer of a map or a sweep: its numbers lie in the page, results over axes. A place is an
// index for each axis, whole at computed points; between them all is interpolated linearly.
for (const root of document.querySelectorAll(".explorer")) {
  const data = JSON.parse(root.querySelector("script").textContent);
  const { axes, results } = data;
  const bytes = Uint8Array.from(atob(data.values), (one) => one.charCodeAt(0));
  const numbers = new Float32Array(bytes.buffer);
  const points = numbers.length / results.length;
  const strides = axes.map((_, n) => axes.slice(n + 1).reduce((a, it) => a * it.values.length, 1));
  const number = Object.fromEntries(results.map((it, n) => [it.name, n]));
  const STEPS = 20; // of a slider from one computed point to the next
  const part = (name) => root.querySelector(`.${name}`);
  const SVG = "http://www.w3.org/2000/svg";
  const PLOT = { left: 62, top: 24, right: 350, bottom: 226 };

  // -- numbers ---------------------------------------------------------------------------------
  // points around a place, each with its weight
  const corners = (place) => place.reduce((found, index, n) => {
    const low = Math.min(Math.floor(index), axes[n].values.length - 1);
    const rest = index - low;
    return found.flatMap(([point, weight]) => {
      const below = [point + low * strides[n], weight * (1 - rest)];
      return rest > 0 ? [below, [point + (low + 1) * strides[n], weight * rest]] : [below];
    });
  }, [[0, 1]]);
  const mean = (name, around) => around.reduce(
    (sum, [point, weight]) => sum + weight * numbers[number[name] * points + point], 0);
  // between points the efficiency is that of the interpolated powers, which are nearer to lines
  const valueOf = (name, around) => {
    const value = mean(name, around);
    if (name !== "efficiency") return value;
    const power = "input_power" in number && around.length > 1 ? mean("input_power", around) : 0;
    return 100 * (power > 0 ? Math.max(0, 1 - mean("total", around) / power) : value);
  };
  const unitOf = (result) => (result.name === "efficiency" ? "%" : result.unit);
  const decimalsOf = (total) =>
    (total > 0 ? Math.min(3, Math.max(0, 2 - Math.floor(Math.log10(total)))) : 0);
  const short = (value, digits = 4) => String(Number(value.toPrecision(digits)));
  const text = (result, value, total) => {
    if (!Number.isFinite(value)) return "-";
    if (result.name === "efficiency") return value.toFixed(2);
    return result.unit === "W" ? value.toFixed(decimalsOf(total)) : short(value);
  };
  const valueAt = (axis, index) => {
    if (!axis.continuous) return axis.values[Math.round(index)];
    const low = Math.min(Math.floor(index), axis.values.length - 2);
    return axis.values[low] + (index - low) * (axis.values[low + 1] - axis.values[low]);
  };
  const indexOf = (axis, value) => {
    const last = axis.values.length - 1;
    const above = axis.values.findIndex((one) => one >= value);
    if (above <= 0) return above === 0 ? 0 : last;
    const [low, high] = [axis.values[above - 1], axis.values[above]];
    return above - 1 + (value - low) / (high - low);
  };
  const axisText = (axis, index, unit = axis.unit) => {
    const value = valueAt(axis, index);
    return typeof value === "number" ? `${short(value, 6)} ${unit}`.trim() : String(value);
  };
  const named = (label, unit) => (unit ? `${label}, ${unit}` : label);
  const ticksOf = (low, high) => {
    const rough = (high - low) / 5 || 1;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 2.5, 5, 10].find((one) => one * power >= rough * 0.999);
    const first = Math.ceil(low / step - 1e-9);
    const count = Math.floor(high / step + 1e-9) - first;
    return Array.from({ length: count + 1 }, (_, n) => Number(((first + n) * step).toPrecision(12)));
  };
  const rangeOf = (values) => {
    let [low, high] = [Infinity, -Infinity];
    for (const one of values) {
      if (one < low) low = one;
      if (one > high) high = one;
    }
    return low < high ? [low, high] : [low - 1, low + 1];
  };

  // -- state and controls ----------------------------------------------------------------------
  const bySize = axes.map((_, n) => n).sort((a, b) =>
    axes[b].continuous - axes[a].continuous || axes[b].values.length - axes[a].values.length);
  const state = {
    place: data.start,
    result: results[number.total],
    over: bySize[0], across: Math.min(...bySize.slice(0, 2)), up: Math.max(...bySize.slice(0, 2)),
    between: true, oneScale: true,
  };
  const make = (tag, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  };
  const labelled = (label, ...content) => make("label", {}, make("span", { textContent: label }), ...content);
  const choice = (label, names, chosen, choose) => {
    const select = make("select");
    select.append(...names.map((name, n) => make("option", { value: n, textContent: name })));
    select.value = chosen;
    select.addEventListener("change", () => { choose(Number(select.value)); show(); });
    return labelled(label, select);
  };
  const sliders = axes.map((axis, n) => {
    const slider = make("input", { type: "range", min: 0 });
    const output = make("output");
    slider.addEventListener("input", () => {
      state.place[n] = Number(slider.value) / stepsOf(axis);
      show();
    });
    part("axes").append(labelled(axis.label, slider, output));
    return { slider, output };
  });
  const stepsOf = (axis) => (axis.continuous && state.between ? STEPS : 1);
  const move = (n, index) => {
    state.place[n] = Math.round(index * stepsOf(axes[n])) / stepsOf(axes[n]);
    show();
  };
  const tick = (label, key) => {
    const box = make("input", { type: "checkbox", checked: true });
    box.addEventListener("change", () => {
      state[key] = box.checked;
      if (!state.between) state.place = state.place.map(Math.round);
      show();
    });
    return make("label", {}, box, make("span", { textContent: label }));
  };
  const axisNames = axes.map((it) => it.label);
  part("choices").append(
    choice("Shown", results.map((it) => it.label), results.indexOf(state.result),
      (n) => { state.result = results[n]; }),
    choice("Curve over", axisNames, state.over, (n) => { state.over = n; }));
  if (axes.length > 1) {
    part("choices").append(
      choice("Map over", axisNames, state.across, (n) => { state.across = n; }),
      choice("and", axisNames, state.up, (n) => { state.up = n; }));
  }
  part("choices").append(
    ...(axes.some((it) => it.continuous) ? [tick("interpolate between computed points", "between")] : []),
    tick("one scale for all places", "oneScale"));

  // -- table -----------------------------------------------------------------------------------
  const rows = ["loss", "sum", "figure"].flatMap((group) => {
    const own = results.filter((it) => it.group === group);
    const body = part(group === "figure" ? "figures" : "losses");
    return own.map((result) => {
      const cells = { value: make("td", { className: "number" }), bar: make("div", { className: "bar" }) };
      const row = make("tr", { className: group === "sum" ? "sum" : "" },
        make("th", { scope: "row", textContent: result.label }), cells.value,
        make("td", { textContent: unitOf(result) }),
        ...(group === "figure" ? [] : [make("td", {}, ...(group === "loss" ? [cells.bar] : []))]));
      body.append(row);
      return { result, ...cells };
    });
  });
  const showTable = () => {
    const around = corners(state.place);
    const total = valueOf("total", around);
    for (const { result, value, bar } of rows) {
      const found = valueOf(result.name, around);
      value.textContent = text(result, found, total);
      bar.style.width = `${total > 0 ? 100 * Math.max(0, found) / total : 0}%`;
    }
    const known = Number.isFinite(total);
    const where = around.length === 1 ? "A computed point." : "Between computed points, interpolated linearly.";
    const failed = "No value: the point, or one next to it, failed.";
    part("where").textContent = known ? where : failed;
    part("command").textContent = axes.map((axis, n) =>
      `--set "${axis.key}=${axisText(axis, state.place[n], axis.stated)}"`).join(" ");
  };

  // -- pictures --------------------------------------------------------------------------------
  const draw = (tag, attributes, content = "") => {
    const made = document.createElementNS(SVG, tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = content;
    return made;
  };
  // from indices of an axis to a length from `start` to `end`, and back
  const scaleOf = (axis, start, end) => {
    const { values, continuous } = axis;
    const cell = (end - start) / values.length;
    const [low, high] = continuous ? [values[0], values.at(-1)] : [0, 1];
    const ends = (value) => start + (value - low) / (high - low) * (end - start);
    if (continuous) {
      return {
        at: (index) => ends(valueAt(axis, index)),
        back: (length) => indexOf(axis, low + (length - start) / (end - start) * (high - low)),
        ticks: ticksOf(low, high).map((one) => [ends(one), short(one, 6)]),
      };
    }
    const every = Math.ceil(values.length / 6);
    return {
      at: (index) => start + (index + 0.5) * cell,
      back: (length) => Math.min(values.length - 1, Math.max(0, Math.floor((length - start) / cell))),
      ticks: values.map((one, n) => [start + (n + 0.5) * cell, String(one)]).filter((_, n) => n % every === 0),
    };
  };
  const frame = (svg, x, y, labels) => {
    const { left, top, right, bottom } = PLOT;
    svg.append(draw("path", { d: `M${left} ${top}V${bottom}H${right}`, class: "axis" }));
    for (const [length, name] of x) {
      svg.append(draw("path", { d: `M${length} ${bottom}v4`, class: "axis" }),
        draw("text", { x: length, y: bottom + 16, "text-anchor": "middle" }, name));
    }
    for (const [length, name] of y) {
      svg.append(draw("path", { d: `M${left} ${length}h-4`, class: "axis" }),
        draw("text", { x: left - 7, y: length + 4, "text-anchor": "end" }, name));
    }
    const [middle, centre] = [(left + right) / 2, (top + bottom) / 2];
    svg.append(draw("text", { x: middle, y: bottom + 34, "text-anchor": "middle" }, labels[0]),
      draw("text", { x: 0, y: 0, "text-anchor": "middle", transform: `translate(12 ${centre}) rotate(-90)` }, labels[1]));
  };
  const here = (svg, d) => svg.append(draw("path", { d, class: "halo" }), draw("path", { d, class: "here" }));
  const clear = (svg, title, go) => {
    svg.replaceChildren();
    svg.setAttribute("aria-label", title);
    svg.parentElement.querySelector("figcaption span").textContent = title;
    svg.onclick = (event) => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      const { left, top, right, bottom } = PLOT;
      if (at.x >= left && at.x <= right && at.y >= top && at.y <= bottom) go(at);
    };
  };
  const others = (...shown) => axes.map((axis, n) => [axis, n]).filter(([, n]) => !shown.includes(n))
    .map(([axis, n]) => `${axis.label} ${axisText(axis, state.place[n])}`).join(", ");
  const titled = (...shown) => [state.result.label, others(...shown)].filter(Boolean).join(" at ");
  const everywhere = () => {
    const first = number[state.result.name] * points;
    const [low, high] = rangeOf(numbers.subarray(first, first + points));
    return state.result.name === "efficiency" ? [100 * low, 100 * high] : [low, high];
  };
  const at = (...changes) => {
    const place = [...state.place];
    for (const [n, index] of changes) place[n] = index;
    return valueOf(state.result.name, corners(place));
  };

  const showCurve = () => {
    const { over, result } = state;
    const [axis, svg] = [axes[over], part("curve")];
    const scale = scaleOf(axis, PLOT.left, PLOT.right);
    const steps = stepsOf(axis);
    const found = Array.from({ length: (axis.values.length - 1) * steps + 1 },
      (_, n) => [n / steps, at([over, n / steps])]);
    const [low, high] = state.oneScale ? everywhere() : rangeOf(found.map(([, one]) => one));
    const y = (value) => PLOT.bottom - (value - low) / (high - low) * (PLOT.bottom - PLOT.top - 6);
    clear(svg, titled(over), (where) => move(over, scale.back(where.x)));
    frame(svg, scale.ticks, ticksOf(low, high).map((one) => [y(one), short(one, 6)]),
      [named(axis.label, axis.unit), named(result.label, unitOf(result))]);
    let pen = "M";
    const path = found.map(([index, value]) => {
      const step = Number.isFinite(value) ? `${pen}${scale.at(index).toFixed(1)} ${y(value).toFixed(1)}` : "";
      pen = step && axis.continuous ? "L" : "M";
      return step;
    }).join("");
    svg.append(draw("path", { d: path, class: "line" }));
    const computed = state.place.every((index, n) => n === over || Number.isInteger(index));
    for (const [index, value] of found) {
      if (!Number.isInteger(index) || !Number.isFinite(value) || !(computed || steps === 1)) continue;
      svg.append(draw("circle", { cx: scale.at(index), cy: y(value), r: 2.5,
        class: computed ? "computed" : "between" }));
    }
    const [x, value] = [scale.at(state.place[over]), at()];
    here(svg, `M${x} ${PLOT.top}V${PLOT.bottom}`);
    if (Number.isFinite(value)) svg.append(draw("circle", { cx: x, cy: y(value), r: 5, class: "now" }));
  };

  // colours of efficiencies are even in the logarithm of the loss, as in the still pictures
  const { least, best, ticks: efficiencies } = data.efficiency;
  const heightOf = (value) => (state.result.name === "efficiency"
    ? -Math.log10(100 - Math.min(best, Math.max(least, value))) : value);
  const colourOf = (value, [low, high]) => {
    const share = high > low ? (heightOf(value) - low) / (high - low) : 0;
    const n = Math.round(Math.min(1, Math.max(0, share)) * (data.colours.length - 1));
    return data.colours[n];
  };
  const showBar = (svg, [low, high], range) => {
    const { top, right, bottom } = PLOT;
    const [from, width, count] = [right + 12, 12, data.colours.length];
    const height = (bottom - top) / count;
    data.colours.forEach((fill, n) => svg.append(
      draw("rect", { x: from, y: bottom - (n + 1) * height, width, height: height + 0.5, fill })));
    const ticks = state.result.name === "efficiency" ? efficiencies : ticksOf(low, high);
    for (const one of ticks.filter((it) => it >= low && it <= high)) {
      const y = bottom - (heightOf(one) - range[0]) / (range[1] - range[0]) * (bottom - top);
      svg.append(draw("text", { x: from + width + 4, y: y + 4 }, short(one, 6)));
    }
  };
  const showMap = () => {
    const { across, up, result } = state;
    const svg = part("map");
    svg.parentElement.hidden = across === up || axes.length < 2;
    if (svg.parentElement.hidden) return;
    const { left, top, right, bottom } = PLOT;
    const [x, y] = [scaleOf(axes[across], left, right), scaleOf(axes[up], bottom, top)];
    const canvas = make("canvas", { width: 90, height: 72 });
    const [wide, high] = [(right - left) / canvas.width, (bottom - top) / canvas.height];
    const nearest = (n, index) => (state.between && axes[n].continuous ? index : Math.round(index));
    const field = Array.from({ length: canvas.width * canvas.height }, (_, n) => {
      const [column, row] = [n % canvas.width, Math.floor(n / canvas.width)];
      return at([across, nearest(across, x.back(left + (column + 0.5) * wide))],
        [up, nearest(up, y.back(top + (row + 0.5) * high))]);
    });
    const limits = state.oneScale ? everywhere() : rangeOf(field);
    const range = limits.map(heightOf);
    const pen = canvas.getContext("2d");
    field.forEach((value, n) => {
      if (!Number.isFinite(value)) return;
      pen.fillStyle = colourOf(value, range);
      pen.fillRect(n % canvas.width, Math.floor(n / canvas.width), 1, 1);
    });
    clear(svg, titled(across, up), (where) => {
      state.place[across] = nearest(across, x.back(where.x));
      move(up, y.back(where.y));
    });
    svg.append(draw("image", { href: canvas.toDataURL(), x: left, y: top, width: right - left,
      height: bottom - top, preserveAspectRatio: "none" }));
    frame(svg, x.ticks, y.ticks,
      [named(axes[across].label, axes[across].unit), named(axes[up].label, axes[up].unit)]);
    showBar(svg, limits, range);
    svg.append(draw("text", { x: right + 12, y: top - 8 }, unitOf(result)));
    const [h, v] = [x.at(state.place[across]), y.at(state.place[up])];
    here(svg, `M${h} ${top}V${bottom}M${left} ${v}H${right}`);
    svg.append(draw("circle", { cx: h, cy: v, r: 5, class: "now" }));
  };

  const show = () => {
    sliders.forEach(({ slider, output }, n) => {
      const shown = axisText(axes[n], state.place[n]);
      slider.max = (axes[n].values.length - 1) * stepsOf(axes[n]);
      slider.value = Math.round(state.place[n] * stepsOf(axes[n]));
      slider.setAttribute("aria-valuetext", shown);
      output.textContent = shown;
    });
    showTable();
    showCurve();
    showMap();
  };
  show();
  root.closest("section").hidden = false;
}
