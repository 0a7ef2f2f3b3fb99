// Turns the layers of drawings and shows one mesh position after the other.
const turning = {
  drawings: new Map(),
  phase: 0,
  running: null,

  add(id, data) {
    const holder = document.getElementById(id);
    const layers = data.layers.map((layer) => ({ ...layer, element: unclipped(holder, layer.name) }));
    const positions = data.phases.map((_, number) =>
      holder.querySelectorAll(`[id^="${CSS.escape(data.position)}-${number}-"]`));
    positions.flatMap((shown) => [...shown]).forEach((one) => { one.style.display = "none"; });
    turning.drawings.set(id, { holder, layers, positions, phases: data.phases, shown: -1 });
    turning.turn(data.phase);
  },

  turn(phase) {
    turning.phase = phase;
    for (const [id, drawing] of turning.drawings) {
      if (!drawing.holder.isConnected) turning.drawings.delete(id);
      else show(drawing, phase);
    }
  },

  play(button) {
    const icon = button.querySelector("i");
    if (turning.running) {
      cancelAnimationFrame(turning.running);
      turning.running = null;
      icon.textContent = "play_arrow";
      return;
    }
    icon.textContent = "pause";
    let last = null;
    const step = (now) => {
      if (last !== null) turning.turn(turning.phase + (now - last) / SECONDS_PER_PERIOD / 1000);
      last = now;
      turning.running = button.isConnected ? requestAnimationFrame(step) : null;
    };
    turning.running = requestAnimationFrame(step);
  },
};
const SECONDS_PER_PERIOD = 2;

// A layer whose clip stays where it is while the layer turns.
function unclipped(holder, name) {
  const layer = holder.querySelector(`#${CSS.escape(name)}`);
  const clip = layer.firstElementChild.getAttribute("clip-path");
  if (clip) {
    const frame = document.createElementNS(layer.namespaceURI, "g");
    frame.setAttribute("clip-path", clip);
    layer.replaceWith(frame);
    frame.append(layer);
    layer.firstElementChild.removeAttribute("clip-path");
  }
  return layer;
}

function show(drawing, phase) {
  const inside = phase - Math.floor(phase);
  const turned = drawing.phases.length ? inside : phase;
  for (const { element, x, y, start, rate } of drawing.layers) {
    element.setAttribute("transform", `rotate(${-(start + rate * turned)} ${x} ${y})`);
  }
  if (!drawing.phases.length) return;
  const away = drawing.phases.map((one) => Math.min(Math.abs(one - inside), 1 - Math.abs(one - inside)));
  const nearest = away.indexOf(Math.min(...away));
  if (nearest === drawing.shown) return;
  drawing.positions[drawing.shown]?.forEach((one) => { one.style.display = "none"; });
  drawing.positions[nearest].forEach((one) => { one.style.display = ""; });
  drawing.shown = nearest;
}
