// Fills the report's plots (uPlot, one shared time axis each for the run and its last steps), and
// highlights the current section. Without the plotting library the plots are already SVG. Controls
// (keys, buttons, lists) are in report_keys.js, through `report`.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const colour = name => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

  // Numbers are encoded as base64 of little-endian floats.
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
  const floats = text => Array.from(new Float32Array(bytes(text)), v => (Number.isFinite(v) ? v : null));

  const grids = {};
  for (const [name, grid] of Object.entries(data.grids || {})) {
    grids[name] = { time: Array.from(new Float64Array(bytes(grid.x))), bands: grid.bands, plots: [], range: null };
  }

  // Draws the state bands behind the curves; only those in view.
  function drawBands(grid) {
    const colours = data.states.map(s => colour(s.colour));
    return u => {
      const { left, top, width, height } = u.bbox;
      const { min, max } = u.scales.x;
      u.ctx.save();
      for (const [begin, end, state] of grid.bands) {
        if (end < min || begin > max) continue;
        const from = Math.max(left, u.valToPos(begin, "x", true));
        const to = Math.min(left + width, u.valToPos(end, "x", true));
        u.ctx.fillStyle = colours[state];
        u.ctx.fillRect(from, top, Math.max(0, to - from), height);
      }
      u.ctx.restore();
    };
  }

  // Zooming one plot zooms all plots of the same axis. uPlot reports a change some time after the
  // request, so only changed ranges are passed on to the others.
  const same = (a, b) => Math.abs(a.min - b.min) < 1e-9 && Math.abs(a.max - b.max) < 1e-9;
  function follow(grid) {
    return (u, key) => {
      const { min, max } = u.scales.x;
      if (key !== "x" || u.status !== 1 || same({ min, max }, grid.range || whole(grid))) return;
      setRange(grid, same({ min, max }, whole(grid)) ? null : { min, max }, u);
    };
  }

  const digits = v => (v == null ? "–" : Math.abs(v) >= 1000 ? v.toFixed(0) : v.toPrecision(4));

  function stateAt(grid, time) {
    const found = grid.bands.find(b => time >= b[0] && time <= b[1]);
    return found ? data.states[found[2]].name : "";
  }

  // Event marks: one line each, at most one a pixel.
  const marks = data.marks || [];
  const markColours = { edit: "link", push: "warn", hold: "warn", inject: "warn", fault: "bad" };
  function drawMarks(u) {
    const { left, top, width, height } = u.bbox;
    const { min, max } = u.scales.x;
    const ratio = devicePixelRatio, last = {};
    u.ctx.save();
    u.ctx.lineWidth = ratio;
    u.ctx.setLineDash([3 * ratio, 3 * ratio]);
    for (const [time, kind] of marks) {
      if (time < min || time > max) continue;
      const x = Math.round(u.valToPos(time, "x", true));
      if (x < left || x > left + width || x - (last[kind] ?? -9) < 4 * ratio) continue;
      last[kind] = x;
      u.ctx.strokeStyle = colour(markColours[kind] || "warn");
      // Faults may be many: draw only a tick at the top.
      const end = kind === "fault" ? top + 12 * ratio : top + height;
      u.ctx.beginPath();
      u.ctx.moveTo(x, top);
      u.ctx.lineTo(x, end);
      u.ctx.stroke();
    }
    u.ctx.restore();
  }

  // Sets the range of all plots of an axis; null: the whole run.
  function setRange(grid, range, but) {
    grid.range = range;
    for (const u of grid.plots) if (u !== but) u.setScale("x", range || whole(grid));
  }
  const whole = grid => ({ min: grid.time[0], max: grid.time[grid.time.length - 1] });
  const runs = {};  // hidden runs, by number

  function options(plot, grid, width) {
    const axis = { stroke: colour("dim"), font: "11.5px system-ui, sans-serif", ticks: { show: false },
      grid: { stroke: colour("grid"), width: 1 } };
    return {
      width, height: 210, padding: [8, 8, 0, 0],
      scales: { x: { time: false } },
      cursor: { sync: { key: plot.grid }, drag: { x: true, y: false }, points: { size: 5 } },
      axes: [
        { ...axis, size: 26, values: (u, ticks) => ticks.map(t => +t.toFixed(4) + " s"), space: 70 },
        { ...axis, size: 52, values: (u, ticks) => ticks.map(t => String(+t.toPrecision(6))) },
      ],
      series: [
        { label: "time", value: (u, t) => (t == null ? "–" : t.toFixed(3) + " s " + stateAt(grid, t)) },
        ...plot.curves.map(c => ({ label: c.label, stroke: colour(c.colour), width: c.dashed ? 1 : 1.5,
          dash: c.dashed ? [5, 4] : undefined, show: !runs[c.run], points: { show: false }, spanGaps: false,
          value: (u, v) => digits(v) })),
      ],
      legend: { markers: { width: 2, fill: "transparent",
        dash: (u, i) => (i > 0 && plot.curves[i - 1].dashed ? "dashed" : "solid") } },
      hooks: { drawClear: [drawBands(grid)], draw: [drawMarks], setScale: [follow(grid)] },
    };
  }

  function draw(place) {
    const plot = data.plots[place.dataset.plot], grid = grids[plot.grid];
    if (place.uplot) {
      grid.plots.splice(grid.plots.indexOf(place.uplot), 1);
      place.uplot.destroy();
    }
    plot.values ||= plot.curves.map(c => floats(c.y));
    place.uplot = new uPlot(options(plot, grid, place.clientWidth), [grid.time, ...plot.values], place);
    if (grid.range) place.uplot.setScale("x", grid.range);
    grid.plots.push(place.uplot);
  }

  const places = [...document.querySelectorAll("[data-plot]")];
  for (const place of places) place.tabIndex = 0;
  if (globalThis.uPlot && places.length) {
    // Plots are drawn when scrolled near, and again when the width or the colours change.
    const near = new IntersectionObserver(entries => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        near.unobserve(entry.target);
        draw(entry.target);
        new ResizeObserver(() => {
          const u = entry.target.uplot, width = entry.target.clientWidth;
          if (u && width && u.width !== width) u.setSize({ width, height: u.height });
        }).observe(entry.target);
      }
    }, { rootMargin: "600px" });
    places.forEach(place => near.observe(place));
    addEventListener("beforeprint", () => places.filter(place => !place.uplot).forEach(draw));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () =>
      places.filter(place => place.uplot).forEach(draw));
  }

  // Highlights the entry of the section in the upper part of the window.
  const links = new Map([...document.querySelectorAll("nav a")].map(a => [a.getAttribute("href").slice(1), a]));
  const seen = new IntersectionObserver(entries => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      links.forEach(a => a.classList.remove("here"));
      const link = links.get(entry.target.id);
      if (!link) continue;
      link.classList.add("here");
      const bar = link.parentElement;
      if (bar.scrollWidth > bar.clientWidth) bar.scrollTo({ left: link.offsetLeft - 40 });
    }
  }, { rootMargin: "-12% 0px -80% 0px" });
  document.querySelectorAll("section[id]").forEach(section => seen.observe(section));

  globalThis.report = {
    marks, setRange, whole,
    grids: () => Object.values(grids).filter(grid => grid.time.length > 1),
    interactive: Boolean(globalThis.uPlot && places.length),
    // Shows or hides the curves of one run in every plot.
    showRun(run, show) {
      runs[run] = !show;
      for (const place of places) {
        data.plots[place.dataset.plot].curves.forEach((c, i) => {
          if (c.run === run && place.uplot) place.uplot.setSeries(i + 1, { show });
        });
      }
    },
  };
})();
