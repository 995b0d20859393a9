// Charts of a page: uPlot from the numbers that stand beside each. Nothing is fetched.
"use strict";
(() => {
  const root = document.documentElement;
  const stored = () => { try { return localStorage.getItem("idc-theme"); } catch { return null; } };
  const preferred = () => stored() ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  const charts = [];
  const setTheme = (theme) => {
    root.dataset.theme = theme;
    for (const chart of charts) {
      chart.plot?.redraw(false, true);
      chart.plot?.root.querySelectorAll(".u-marker").forEach((marker, which) => {
        // uPlot paints them once. The first is that of the horizontal axis.
        if (which > 0) marker.style.borderColor = chart.plot.series[which].stroke(chart.plot, which);
      });
    }
  };
  setTheme(preferred());
  document.getElementById("theme").addEventListener("click", () => {
    const theme = root.dataset.theme === "dark" ? "light" : "dark";
    try { localStorage.setItem("idc-theme", theme); } catch { /* the page stands in a place without storage */ }
    setTheme(theme);
  });
  const colour = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();
  const faded = (name, share) => colour(name) + Math.round(255 * share).toString(16).padStart(2, "0");

  // Little-endian Float32 in base64; NaN is no value.
  const numbers = (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return Array.from(new Float32Array(bytes.buffer), (value) => (Number.isNaN(value) ? null : value));
  };
  const shown = (value) => (value == null ? "–" : String(Number(value.toPrecision(5))));

  const strokes = {
    Plain: { width: 1.5 }, Dashed: { width: 1.5, dash: [6, 4] }, Raw: { width: 1, share: 0.7 }, Truth: { width: 2.2 },
    Points: { points: true }, Mark: { points: true, size: 12, fill: 1 }, Area: { width: 0.5, share: 0.6 },
  };
  const series = (content) => {
    const stroke = strokes[content.stroke];
    const paint = () => (stroke.share ? faded(content.role, stroke.share) : colour(content.role));
    const built = { label: content.label, stroke: paint, width: stroke.width, dash: stroke.dash, spanGaps: content.joined, value: (_, v) => shown(v), scale: "y" };
    if (stroke.points) {
      built.paths = () => null;
      built.points = { show: true, size: stroke.size ?? 4, width: 0, stroke: paint, fill: () => faded(content.role, stroke.fill ?? 0.55), filter: null };
    } else {
      built.points = { show: false };
      if (content.stepwise) built.paths = uPlot.paths.stepped({ align: 1 });
    }
    return built;
  };

  // Horizontal bands, flagged times and event lines, behind the signals.
  const backdrop = (content) => (u) => {
    const { ctx, bbox } = u;
    const ratio = uPlot.pxRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    for (const span of content.spans) {
      const [from, to] = [u.valToPos(span[0], "x", true), u.valToPos(span[1], "x", true)];
      ctx.fillStyle = faded("bad", 0.12);
      ctx.fillRect(from, bbox.top, Math.max(to - from, ratio), bbox.height);
    }
    for (const band of content.bands) {
      const [top, bottom] = [u.valToPos(band.to, "y", true), u.valToPos(band.from, "y", true)];
      ctx.fillStyle = faded("Band", 0.25);
      ctx.fillRect(bbox.left, top, bbox.width, Math.max(bottom - top, ratio));
    }
    ctx.strokeStyle = colour("quiet");
    ctx.lineWidth = ratio;
    ctx.setLineDash([3 * ratio, 3 * ratio]);
    for (const marker of content.markers) {
      const at = u.valToPos(marker.at, "x", true);
      ctx.beginPath();
      ctx.moveTo(at, bbox.top);
      ctx.lineTo(at, bbox.top + bbox.height);
      ctx.stroke();
    }
    ctx.restore();
    names(content)(u);
  };

  // Names of the phases in a band of their own above the signals, each from where its phase begins, one that would lie on another a line lower.
  const line = 14;
  const lines = (content) => Math.min(3, content.markers.length);
  const names = (content) => (u) => {
    const { ctx, bbox } = u;
    const ratio = uPlot.pxRatio;
    const [left, right, top] = [bbox.left, bbox.left + bbox.width, bbox.top - (lines(content) * line + 4) * ratio];
    u.names = [];
    ctx.save();
    ctx.font = `${11 * ratio}px system-ui, sans-serif`;
    ctx.textAlign = "left";
    ctx.textBaseline = "middle";
    ctx.strokeStyle = ctx.fillStyle = colour("quiet");
    ctx.lineWidth = ratio;
    const ends = Array(lines(content)).fill(-Infinity);
    content.markers.forEach((marker, which) => {
      const begins = u.valToPos(marker.at, "x", true);
      const next = content.markers[which + 1];
      const over = next ? u.valToPos(next.at, "x", true) : Infinity;
      if (begins > right || over <= left) return;
      const width = ctx.measureText(marker.label).width;
      const at = Math.max(left, begins);
      // Where there is no room after its line it stands before it.
      const after = at + 4 * ratio;
      const word = Math.max(left, after + width <= right ? after : Math.min(at - 4 * ratio, right) - width);
      const free = ends.findIndex((end) => end < word);
      if (free < 0) return;
      ends[free] = word + width + 6 * ratio;
      const middle = top + (free + 0.5) * line * ratio;
      ctx.fillText(marker.label, word, middle);
      // From its name down to its line.
      if (begins >= left) {
        ctx.beginPath();
        ctx.moveTo(at, middle - 5 * ratio);
        ctx.lineTo(at, bbox.top);
        ctx.stroke();
      }
      u.names.push({ label: marker.label, left: word / ratio, right: (word + width) / ratio, top: (middle - 6 * ratio) / ratio, bottom: (middle + 6 * ratio) / ratio });
    });
    ctx.restore();
  };

  // Two fingers zoom and move, a double tap shows all.
  const touch = (u) => {
    let start = null;
    let tapped = 0;
    const span = (touches) => {
      const left = u.over.getBoundingClientRect().left;
      return [...touches].map((finger) => finger.clientX - left).sort((a, b) => a - b);
    };
    u.over.addEventListener("touchstart", (event) => {
      if (event.touches.length === 2) {
        event.preventDefault();
        start = span(event.touches).map((x) => u.posToVal(x, "x"));
      } else if (event.timeStamp - tapped < 300) { all(u); } else { tapped = event.timeStamp; }
    }, { passive: false });
    u.over.addEventListener("touchmove", (event) => {
      if (!start || event.touches.length !== 2) return;
      event.preventDefault();
      const [left, right] = span(event.touches);
      const scale = (start[1] - start[0]) / Math.max(right - left, 10);
      const min = start[0] - left * scale;
      u.setScale("x", { min, max: min + u.over.clientWidth * scale });
    }, { passive: false });
    u.over.addEventListener("touchend", () => { start = null; });
  };
  const ends = (u) => [u.data[0][0], u.data[0].at(-1)];
  const all = (u) => { const [min, max] = ends(u); u.setScale("x", { min, max }); };

  const alike = (chart) => charts.filter((other) => other !== chart && other.plot && chart.content.group && other.content.group === chart.content.group);
  const zoomed = (chart) => (u, scale) => {
    if (scale !== "x") return;
    const { min, max } = u.scales.x;
    const [first, last] = ends(u);
    const is = min > first + 1e-9 * (last - first) || max < last - 1e-9 * (last - first);
    chart.figure.classList.toggle("zoomed", is);
    // How a chart begins is nobody's zoom.
    if (u.status === 0) return;
    for (const { plot } of alike(chart)) {
      if (plot.scales.x.min !== min || plot.scales.x.max !== max) plot.setScale("x", { min, max });
    }
  };

  const onScreen = (place) => ({ width: place.clientWidth, height: 280 });
  // The style fits it to the paper, whose width no script knows: sharp enough, and its texts not too small.
  const onPaper = { width: 900, height: 280 };
  const build = (chart) => {
    if (chart.plot) return;
    const content = chart.content;
    const place = chart.figure.querySelector(".plot");
    // Its group may have been zoomed while it was out of sight.
    const shared = alike(chart).find((other) => other.figure.classList.contains("zoomed"))?.plot.scales.x;
    const axis = { stroke: () => colour("quiet"), grid: { stroke: () => colour("grid"), width: 1 }, ticks: { stroke: () => colour("grid"), width: 1 }, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif", labelSize: 20 };
    const largest = (values) => Math.max(...values.map((v) => String(Number((v ?? 0).toPrecision(6))).length));
    const plain = (_, values) => values.map((v) => String(Number(v.toPrecision(6))));
    const options = {
      ...onScreen(place),
      padding: [content.markers.length ? lines(content) * line + 8 : 10, 12, 0, 0],
      cursor: { sync: content.group ? { key: content.group, setSeries: false } : undefined, drag: { x: true, y: false, uni: 20 }, points: { size: 6 } },
      legend: { live: true },
      scales: { x: { time: false, min: shared?.min, max: shared?.max }, y: { range: (_, min, max) => content.within ?? (min == null ? [0, 1] : uPlot.rangeNum(min, max, 0.08, true)) } },
      axes: [{ ...axis, label: content.x, values: plain, size: 30, labelSize: 18 }, { ...axis, label: content.y, values: plain, size: (u, values) => (values ? 22 + 7 * largest(values.map(Number)) : 60) }],
      series: [{ label: content.x, value: (_, v) => shown(v) }, ...content.series.map(series)],
      bands: content.areas.map(([low, high]) => ({ series: [high + 1, low + 1], fill: () => faded("Band", 0.3) })),
      hooks: { drawClear: [backdrop(content)], setScale: [zoomed(chart)], init: [touch] },
    };
    const data = [numbers(content.at), ...content.series.map((one) => numbers(one.values))];
    chart.plot = new uPlot(options, data, place);
    // The other edge of an area has no name of its own.
    const rows = place.querySelectorAll(".u-legend .u-series");
    content.series.forEach((one, which) => { if (!one.label) rows[which + 1].style.display = "none"; });
    place.setAttribute("data-drawn", "");
    new ResizeObserver(() => chart.plot.setSize(onScreen(place))).observe(place);
    chart.figure.querySelector(".reset").addEventListener("click", () => all(chart.plot));
  };

  // Rows by a column: numbers as numbers, the rest as words; again, the other way round.
  for (const table of document.querySelectorAll("table.sortable")) {
    const body = table.tBodies[0];
    for (const [index, head] of [...table.tHead.rows[0].cells].entries()) {
      if (!head.textContent) continue;
      const button = document.createElement("button");
      button.type = "button";
      button.className = "sort";
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const way = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
        for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", way > 0 ? "ascending" : "descending");
        const key = (row) => row.cells[index].textContent.trim();
        const order = (a, b) => {
          const [x, y] = [parseFloat(key(a).replace("<", "")), parseFloat(key(b).replace("<", ""))];
          if (Number.isNaN(x) || Number.isNaN(y)) return (Number.isNaN(x) - Number.isNaN(y)) || way * key(a).localeCompare(key(b));
          return way * (x - y);
        };
        body.append(...[...body.rows].sort(order));
      });
    }
  }

  for (const figure of document.querySelectorAll("figure.chart")) {
    charts.push({ figure, content: JSON.parse(figure.querySelector("script").textContent), plot: null });
  }
  // Those out of sight wait.
  const watch = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (entry.isIntersecting) build(charts.find((chart) => chart.figure === entry.target));
    }
  }, { rootMargin: "400px" });
  for (const chart of charts) watch.observe(chart.figure);
  let before = null;
  addEventListener("beforeprint", () => {
    before ??= root.dataset.theme;
    for (const details of document.querySelectorAll("details")) details.open = true;
    charts.forEach(build);
    setTheme("light");
    for (const chart of charts) chart.plot.setSize(onPaper);
  });
  addEventListener("afterprint", () => {
    if (before) setTheme(before);
    before = null;
    for (const chart of charts) chart.plot?.setSize(onScreen(chart.plot.root.parentElement));
  });
  // For tests: what is drawn, and how far it is zoomed.
  window.idcCharts = charts;
})();
