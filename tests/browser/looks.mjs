// What a reader would wince at in a page as it is shown now: what lies beyond its place or on another, what is cut, pale, or without a name.
// `lookedAt` runs in the page.
export const lookedAt = () => {
  const found = new Set();
  const say = (what, node, more = "") => found.add(`${what}: ${node.nodeType === 3 ? `"${node.data.trim().slice(0, 40)}"` : `<${node.tagName.toLowerCase()} class="${node.getAttribute("class") ?? ""}">`} in ${[...(function* up(one) { for (let at = one.parentElement, i = 0; at && i < 3; at = at.parentElement, i += 1) yield at.tagName.toLowerCase() + (at.getAttribute("class") ? "." + at.getAttribute("class") : ""); })(node)].join(" < ")} ${more}`);
  const round = (box) => [box.left, box.top, box.right, box.bottom].map(Math.round).join(" ");
  const style = new Map();
  const styleOf = (element) => { if (!style.has(element)) style.set(element, getComputedStyle(element)); return style.get(element); };
  const shown = (element) => element.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  // From an element outwards.
  const outwards = function* outwards(element) { for (let at = element; at; at = at.parentElement) yield at; };
  const scrolls = (element) => ["auto", "scroll"].includes(styleOf(element).overflowX) && element !== document.documentElement;

  if (document.documentElement.scrollWidth > innerWidth) found.add(`the page is ${document.documentElement.scrollWidth - innerWidth} px wider than the window`);

  const rgba = (text) => { const parts = text.match(/[\d.]+/g)?.map(Number) ?? [0, 0, 0, 0]; return [...parts.slice(0, 3), parts[3] ?? 1]; };
  const over = ([r, g, b, a], [R, G, B]) => [r, g, b].map((value, i) => a * value + (1 - a) * [R, G, B][i]);
  const luminance = (colour) => {
    const [r, g, b] = colour.map((value) => { const v = value / 255; return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  // WCAG 2.2, 1.4.3.
  const contrast = (one, other) => { const [a, b] = [luminance(one), luminance(other)].sort((x, y) => y - x); return (a + 0.05) / (b + 0.05); };
  const background = (element) => {
    const layers = [];
    for (const at of outwards(element)) {
      const layer = rgba(styleOf(at).backgroundColor);
      if (layer[3] > 0) layers.push(layer);
      if (layer[3] === 1) break;
    }
    return layers.reduceRight((below, layer) => over(layer, below), [255, 255, 255]);
  };

  // Texts: within the window and within whatever cuts them off, and seen.
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const range = document.createRange();
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const parent = node.parentElement;
    if (!node.data.trim() || parent.closest("script, style, noscript, title") || !shown(parent)) continue;
    range.selectNodeContents(node);
    const box = range.getBoundingClientRect();
    if (box.width === 0) continue;
    const svg = parent.closest("svg");
    if (svg) {
      const within = svg.getBoundingClientRect();
      if (box.left < within.left - 1 || box.right > within.right + 1 || box.top < within.top - 1 || box.bottom > within.bottom + 1) say("beyond its picture", node, `${round(box)} not in ${round(within)}`);
    }
    let free = false;
    for (const at of outwards(parent)) {
      if (scrolls(at)) { free = true; break; }
      if (at === document.documentElement || at === document.body || (svg && svg.contains(at)) || styleOf(at).display === "inline") continue;
      if (styleOf(at).overflowX === "visible") continue;
      const within = at.getBoundingClientRect();
      if (box.left < within.left - 1 || box.right > within.right + 1 || box.top < within.top - 1 || box.bottom > within.bottom + 1) say("cut", node, `${round(box)} not in ${round(within)}`);
    }
    if (!free && (box.left < -1 || box.right > innerWidth + 1)) say("beyond the window", node, round(box));
    const paint = svg ? styleOf(parent).fill : styleOf(parent).color;
    const ground = background(svg ? svg.parentElement : parent);
    const seen = contrast(over(rgba(paint), ground), ground);
    if (seen < 4.5) say("pale", node, `${seen.toFixed(2)}, ${paint} on ${ground.map(Math.round)}`);
  }

  // Boxes: within their parents, unless something between scrolls or is placed elsewhere on purpose.
  for (const element of document.body.querySelectorAll("*")) {
    if (element.closest("svg, script, .u-wrap") || !shown(element) || ["absolute", "fixed"].includes(styleOf(element).position) || styleOf(element).display.startsWith("inline") || styleOf(element).display === "contents") continue;
    const parent = element.parentElement;
    if (scrolls(parent) || styleOf(parent).display.startsWith("inline")) continue;
    const [box, within] = [element.getBoundingClientRect(), parent.getBoundingClientRect()];
    if (box.width > 0 && (box.left < within.left - 1 || box.right > within.right + 1)) say("beyond its parent", element, `${round(box)} not in ${round(within)}`);
  }

  // Words of one picture, none on another.
  const apart = (all) => all.forEach(([one, a], which) => all.slice(which + 1).forEach(([other, b]) => {
    const [wide, high] = [Math.min(a.right, b.right) - Math.max(a.left, b.left), Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)];
    // A line's box is higher than its letters.
    if (wide > 1.5 && high > 0.3 * Math.min(a.bottom - a.top, b.bottom - b.top)) say(`on "${other}"`, { nodeType: 3, data: one, parentElement: null });
  }));
  const boxes = (all) => [...all].filter((text) => text.textContent.trim() && shown(text)).map((text) => [text.textContent.trim(), text.getBoundingClientRect()]);
  for (const svg of document.querySelectorAll("svg")) {
    // Words that are turned have boxes that say little.
    apart(boxes([...svg.querySelectorAll("text")].filter((text) => !/rotate|matrix/.test(text.getAttribute("transform") ?? ""))));
  }
  for (const place of document.querySelectorAll(".space .over")) apart(boxes(place.children));

  // What charts paint.
  const pen = document.createElement("canvas").getContext("2d");
  pen.font = "12px system-ui, sans-serif";
  const inside = (what, box, [left, top, right, bottom]) => {
    if (box.left < left - 1 || box.right > right + 1 || box.top < top - 1 || box.bottom > bottom + 1) found.add(`painted beyond its place: ${what}: ${round(box)} not in ${[left, top, right, bottom].map(Math.round).join(" ")}`);
  };
  for (const { plot } of (window.idcCharts ?? []).filter((chart) => chart.plot)) {
    const ratio = devicePixelRatio;
    const [left, top, width, height] = [plot.bbox.left, plot.bbox.top, plot.bbox.width, plot.bbox.height].map((v) => v / ratio);
    const title = plot.axes[1].label;
    // Names of phases have a band of their own above the signals.
    for (const name of plot.names) inside(`phase ${name.label} of ${title}`, name, [0, 0, plot.width, top]);
    apart(plot.names.map((name) => [name.label, name]));
    const [across, up] = plot.axes;
    for (const value of up._values ?? []) {
      if (value === null) continue;
      const wide = pen.measureText(value).width;
      // Between the axis's own name and its ticks.
      inside(`${value} of ${title}`, { left: left - 15 - wide, right: left, top: 0, bottom: 0 }, [up.labelSize - 4, 0, left, height]);
    }
    const places = (across._values ?? []).flatMap((value, which) => {
      if (value === null) return [];
      const [middle, wide] = [left + plot.valToPos(across._splits[which], "x"), pen.measureText(value).width];
      return [[value, { left: middle - 0.5 * wide, right: middle + 0.5 * wide, top: 0, bottom: 10 }]];
    });
    for (const [value, box] of places) inside(`${value} below ${title}`, { ...box, bottom: 0 }, [0, 0, plot.width, height]);
    apart(places);
    inside(`name of ${title}`, { left: 0, right: pen.measureText(title).width, top: 0, bottom: 0 }, [0, 0, height, height]);
    inside(`name below ${title}`, { left: 0, right: pen.measureText(across.label).width, top: 0, bottom: 0 }, [0, 0, width, height]);
  }

  // Names for those who do not see it.
  for (const table of document.querySelectorAll("table:not(.u-legend)")) {
    const heads = [...table.querySelectorAll("th[scope]")];
    if (heads.length === 0) say("a table without headers", table);
    for (const head of heads) if (!head.textContent.trim() && !head.getAttribute("aria-label")) say("a header without words", table);
  }
  for (const picture of document.querySelectorAll("svg, canvas, img")) {
    const named = [...outwards(picture)].some((at) => at.getAttribute("aria-label") || at.getAttribute("alt")) || picture.querySelector("title") || picture.closest("figure")?.querySelector("figcaption");
    if (!named) say("a picture without words", picture);
  }
  return [...found];
};
