"use strict";
// Each figure is a still one; a button puts one to explore in its place, drawn by plotly.js, which
// lies packed in this page and is unpacked when it is first asked for.
(() => {
  let library = null;
  const load = () => {
    library ??= (async () => {
      const packed = Uint8Array.from(
        atob(document.getElementById("plotly").textContent), (one) => one.charCodeAt(0));
      const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
      const script = document.createElement("script");
      script.textContent = await new Response(stream).text();
      document.head.append(script);
    })();
    return library;
  };
  const font = { family: getComputedStyle(document.body).fontFamily, size: 12 };
  const explore = async (figure, still, button) => {
    let chart = figure.querySelector(".explored");
    const shown = chart !== null && !chart.hidden;
    if (shown) {
      chart.hidden = true;
    } else {
      await load();
      if (chart === null) {
        const { data, layout } = JSON.parse(figure.querySelector(".plot").textContent);
        chart = document.createElement("div");
        chart.className = "explored";
        chart.style.height = `${still.offsetHeight}px`;
        still.after(chart);
        Plotly.newPlot(chart, data, {
          ...layout, title: undefined, font, margin: { t: 36, r: 24, b: 56, l: 64 },
          legend: { orientation: "h", y: -0.25 },
        }, {
          displaylogo: false, responsive: true,
          modeBarButtons: [["zoom2d", "pan2d", "resetScale2d", "toImage"]],
        });
      }
      chart.hidden = false;
    }
    still.hidden = !shown;
    button.textContent = shown ? "Explore" : "Back";
  };
  if (!("DecompressionStream" in window)) return;
  for (const plot of document.querySelectorAll("script.plot")) {
    const figure = plot.parentElement;
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "Explore";
    button.addEventListener("click", () => explore(figure, figure.querySelector(".still"), button));
    figure.querySelector("figcaption").append(button);
  }
})();
