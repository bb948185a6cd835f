// Curves over time: one marker of the current time, one zoom, legends with the values there.
carom.makeCharts = (clock, gutter) => {
  const { create, number, inUnit } = carom.format;
  const HEIGHT = 128;
  const TALL = 250;
  const CLICK = 4; // pixels that a click may move
  const charts = new Set();
  const zoomListeners = [];
  let zoom = null;

  // The same part of the time in all charts.
  function setZoom(low, high) {
    if (zoom && zoom[0] === low && zoom[1] === high) return;
    zoom = [low, high];
    for (const chart of charts) {
      const { min, max } = chart.plot.scales.x;
      if (min !== low || max !== high) chart.plot.setScale("x", { min: low, max: high });
    }
    for (const listener of zoomListeners) listener(low, high);
  }

  function nearest(times, wanted) {
    let low = 0;
    let high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= wanted) low = middle; else high = middle;
    }
    return wanted - times[low] <= times[high] - wanted ? low : high;
  }

  // `curves`: label, colour and values of each, over `times`.
  function add(parent, { id, title, unit, log, tall, steps, limit, curves, times }) {
    const panel = create("div", { className: "panel", id: `panel-${id}` });
    const heading = create("h2", {}, unit ? `${title} [${unit}]` : title);
    const printed = create("div", { className: "printed" });
    const legend = create("ul", { className: "legend" });
    const holder = create("div", { className: "chart" });
    const marker = create("div", { className: "now" });
    panel.append(heading, legend, holder, printed);
    parent.append(panel);

    const shown = curves.map((curve) => ({ ...curve, values: log ? positive(curve.values) : finite(curve.values) }));
    if (limit) shown.push({ label: "allowed", colour: "red", values: times.map(() => limit), dash: [5, 4] });
    const colour = (name) => () => carom.theme.colour(name);
    const axis = {
      stroke: colour("faint"),
      grid: { stroke: colour("line"), width: 1 },
      ticks: { stroke: colour("line"), width: 1, size: 4 },
      font: "12px system-ui, sans-serif",
      values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : number(tick, 6))),
    };
    const plot = new uPlot(
      {
        width: 100,
        height: tall ? TALL : HEIGHT,
        legend: { show: false },
        padding: [8, 16, 0, 0],
        scales: { x: { time: false }, y: log ? { distr: 3 } : { range: withRoom } },
        axes: [
          { ...axis, size: 28, space: 70, values: (_, ticks) => ticks.map((tick) => inUnit(tick, 6)) },
          { ...axis, size: gutter, space: 28, ...(log ? { splits: decades, filter: (_, ticks) => ticks } : {}) },
        ],
        series: [
          {},
          ...shown.map((curve) => ({
            label: curve.label,
            stroke: colour(curve.colour),
            width: 1.6,
            dash: curve.dash,
            points: { show: times.length === 1 },
            paths: steps ? uPlot.paths.stepped({ align: -1 }) : undefined,
            value: (_, value) => number(value, 5),
          })),
        ],
        cursor: { drag: { x: true, y: false, dist: CLICK }, sync: { key: "carom" }, points: { size: 6 } },
        hooks: {
          draw: [() => mark()],
          setCursor: [(plot) => showValues(plot.cursor.idx)],
          setScale: [(plot, key) => {
            if (key === "x") setZoom(plot.scales.x.min, plot.scales.x.max);
          }],
        },
      },
      [times, ...shown.map((curve) => curve.values)],
      holder,
    );
    plot.over.append(marker);
    plot.over.setAttribute("role", "img");
    plot.over.setAttribute("aria-label", `${title} over time: ${shown.map((curve) => curve.label).join(", ")}`);

    const numbers = shown.map((curve, index) => {
      const value = create("b");
      const swatch = create("i");
      swatch.style.setProperty("--c", `var(--${curve.colour})`);
      const button = create("button", { type: "button", title: "Show or hide" }, swatch, curve.label, value);
      button.setAttribute("aria-pressed", "true");
      button.addEventListener("click", () => {
        const visible = button.getAttribute("aria-pressed") !== "true";
        button.setAttribute("aria-pressed", String(visible));
        plot.setSeries(index + 1, { show: visible });
      });
      legend.append(create("li", {}, button));
      return value;
    });

    function showValues(hovered) {
      const row = hovered ?? nearest(times, clock.time);
      shown.forEach((curve, index) => {
        numbers[index].textContent = number(curve.values[row], 5);
      });
    }
    function mark() {
      const place = plot.valToPos(clock.time, "x");
      const inside = place >= 0 && place <= plot.over.clientWidth;
      marker.hidden = !inside;
      marker.style.left = `${place}px`;
      marker.dataset.time = String(clock.time);
    }

    let pressed = null;
    plot.over.addEventListener("mousedown", (event) => { pressed = event.clientX; });
    plot.over.addEventListener("click", (event) => {
      if (pressed === null || Math.abs(event.clientX - pressed) > CLICK) return;
      clock.pause();
      clock.seek(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
    });
    const observer = new ResizeObserver(() => {
      const width = holder.clientWidth;
      if (width && width !== plot.width) plot.setSize({ width, height: plot.height });
    });
    observer.observe(holder);

    // As the chart stands: what is zoomed to, without the curves that are hidden.
    function svg() {
      const { x, y } = plot.scales;
      const visible = shown.filter((_, index) => plot.series[index + 1].show);
      return carom.drawing.svg({
        title, unit, log, steps, times, curves: visible, x: [x.min, x.max], y: [y.min ?? 0, y.max ?? 1], height: tall ? 380 : 240,
      });
    }
    const { button } = carom.save;
    heading.append(create("span", { className: "saves" },
      button("PNG", `Save as PNG: ${title}`, async () => carom.save.picture(await carom.drawing.canvas(svg()), title)),
      button("SVG", `Save as SVG: ${title}`, () => carom.save.text(svg(), title, "svg", "image/svg+xml")),
      button("CSV", `Save as CSV: ${title}`, () => {
        const titles = shown.map(({ label }) => (unit ? `${label} [${unit}]` : label));
        carom.save.csv([["time [s]", ...titles], ...times.map((time, row) => [time, ...shown.map(({ values }) => values[row])])], title);
      })));

    const chart = {
      plot,
      svg,
      printed,
      tell() {
        mark();
        if (plot.cursor.idx === null || plot.cursor.idx === undefined) showValues(null);
      },
      remove() {
        charts.delete(chart);
        observer.disconnect();
        plot.destroy();
        panel.remove();
      },
    };
    charts.add(chart);
    if (zoom) plot.setScale("x", { min: zoom[0], max: zoom[1] });
    chart.tell();
    return chart;
  }

  const finite = (values) => Array.from(values, (value) => (Number.isFinite(value) ? value : null));
  const positive = (values) => Array.from(values, (value) => (Number.isFinite(value) && value > 0 ? value : null));
  // Some room above and below; zero stays an end where all values are on one side of it.
  function withRoom(_, low, high) {
    if (low === null) return [0, 1];
    const room = 0.06 * (high - low || Math.abs(high) || 1);
    return [low >= 0 && low < 0.3 * high ? 0 : low - room, high + room];
  }

  // At most five powers of ten.
  function decades(_, axis, low, high) {
    const [first, last] = [Math.ceil(Math.log10(low)), Math.floor(Math.log10(high))];
    const stride = Math.max(1, Math.ceil((last - first + 1) / 5));
    const powers = [];
    for (let power = first; power <= last; power += stride) powers.push(Number(`1e${power}`));
    return powers;
  }

  clock.onChange(() => { for (const chart of charts) chart.tell(); });
  carom.theme.onChange(() => { for (const chart of charts) chart.plot.redraw(false, true); });
  return { add, all: () => charts, onZoom: (listener) => zoomListeners.push(listener) };
};
