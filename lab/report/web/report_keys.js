// Controls of the report's plots: keys, buttons (for phones), lists of edits and events, filters,
// hiding of runs, stepping through steps. Loaded after report.js.
"use strict";
(() => {
  const { report } = globalThis;
  const all = selector => [...document.querySelectorAll(selector)];

  // Changes each axis in proportion to its range.
  function change(next) {
    for (const grid of report.grids()) {
      const whole = report.whole(grid), now = grid.range || whole;
      const { middle, span } = next((now.min + now.max) / 2, now.max - now.min);
      const full = whole.max - whole.min;
      const wide = Math.min(full, Math.max(span, 0.02));
      if (wide >= full) { report.setRange(grid, null); continue; }
      const min = Math.min(Math.max(middle - wide / 2, whole.min), whole.max - wide);
      report.setRange(grid, { min, max: min + wide });
    }
  }
  const pan = part => change((middle, span) => ({ middle: middle + part * span, span }));
  const zoom = factor => change((middle, span) => ({ middle, span: span * factor }));
  const showWhole = () => report.grids().forEach(grid => report.setRange(grid, null));

  // Centres every plot whose axis contains it on a moment.
  let here = -Infinity;
  const said = document.getElementById("said");
  function goTo(time, what) {
    here = time;
    for (const grid of report.grids()) {
      const whole = report.whole(grid);
      if (time < whole.min || time > whole.max) continue;
      const span = Math.min(1.5, whole.max - whole.min);
      const min = Math.min(Math.max(time - span / 2, whole.min), whole.max - span);
      report.setRange(grid, { min, max: min + span });
    }
    if (said) said.textContent = time.toFixed(3) + " s " + what;
  }
  function mark(direction) {
    const list = report.marks.filter(m => (direction > 0 ? m[0] > here + 1e-6 : m[0] < here - 1e-6));
    const found = direction > 0 ? list[0] : list[list.length - 1];
    if (found) goTo(found[0], found[1]);
  }

  const help = document.getElementById("help");
  const actions = {
    left: () => pan(-0.25), right: () => pan(0.25), closer: () => zoom(0.5), wider: () => zoom(2),
    whole: showWhole, before: () => mark(-1), next: () => mark(1),
    help: () => (help.open ? help.close() : help.showModal()),
  };
  const keys = { ArrowLeft: "left", ArrowRight: "right", "+": "closer", "=": "closer", "-": "wider", "_": "wider",
    0: "whole", "[": "before", "]": "next", "?": "help" };
  const scrollsSideways = target => target.scrollWidth > target.clientWidth + 1 && target.matches(".strip, .wide, .plane");
  addEventListener("keydown", event => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const target = event.target, digit = Number(event.key);
    if (target.matches("input, select, textarea") && event.key !== "?") return;
    if (help.open && event.key !== "?") return;
    if (event.key.startsWith("Arrow") && scrollsSideways(target)) return;
    const u = target.uplot;  // digits toggle curves of the focused plot
    if (u && digit >= 1 && digit < u.series.length) {
      u.setSeries(digit, { show: !u.series[digit].show });
    } else if (keys[event.key]) {
      actions[keys[event.key]]();
    } else {
      return;
    }
    event.preventDefault();
  });
  for (const button of all("[data-action]")) button.addEventListener("click", () => actions[button.dataset.action]());
  if (!document.querySelector("[data-plot], .moments, #step")) document.querySelector(".tools").hidden = true;
  if (!report.interactive) all("[data-action]").forEach(b => { b.hidden = b.dataset.action !== "help"; });

  // In lists of moments a click, or arrows and Enter, moves the plots to the moment.
  for (const list of all(".moments")) {
    const rows = () => [...list.querySelectorAll("tr[data-t]")].filter(row => !row.hidden);
    let chosen = null;
    const choose = row => {
      chosen?.classList.remove("chosen");
      chosen = row;
      row?.classList.add("chosen");
      row?.scrollIntoView({ block: "nearest" });
    };
    const go = row => row && goTo(Number(row.dataset.t), row.dataset.what || "");
    list.addEventListener("click", event => {
      const row = event.target.closest("tr[data-t]");
      if (row) choose(row);
      go(row);
    });
    list.addEventListener("keydown", event => {
      const shown = rows(), at = shown.indexOf(chosen);
      if (event.key === "ArrowDown") choose(shown[Math.min(at + 1, shown.length - 1)]);
      else if (event.key === "ArrowUp") choose(shown[Math.max(at - 1, 0)]);
      else if (event.key === "Enter") go(chosen);
      else return;
      event.preventDefault();
    });
  }
  for (const box of all(".filter input")) {
    box.addEventListener("change", () => {
      for (const row of all(".events tr[data-kind]")) {
        if (row.dataset.kind === box.dataset.kind) row.hidden = !box.checked;
      }
    });
  }

  for (const box of all(".runs input")) {
    box.addEventListener("change", () => {
      const run = Number(box.dataset.run);
      report.showRun(run, box.checked);
      for (const part of all(`svg [data-run="${run}"]`)) part.style.display = box.checked ? "" : "none";
    });
  }

  // Shows one step of the portraits with its prediction; 0: all steps.
  const slider = document.getElementById("step");
  if (slider) {
    const facts = JSON.parse(slider.dataset.facts), output = document.getElementById("step-facts");
    const show = () => {
      const step = Number(slider.value);
      for (const part of all("svg [data-step]")) {
        const own = Number(part.dataset.step) === step;
        part.style.opacity = step === 0 ? "" : own ? 1 : 0.07;
        part.style.strokeWidth = own ? 2.5 : "";
      }
      output.textContent = step === 0 ? `all ${facts.length}` : facts[step - 1].text;
    };
    slider.addEventListener("input", show);
    document.getElementById("step-go")?.addEventListener("click", () => {
      const step = Number(slider.value);
      if (step > 0) goTo(facts[step - 1].t, "end of the step");
    });
    show();
  }
})();
