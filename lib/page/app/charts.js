// Charts that can be zoomed and tell the values under the pointer, in the place
// of the page's drawings, which remain for print.

import uPlot from 'uplot';
import {onFrame, showFrame} from './frames.js';

/** A number as people read it. */
export function rounded(value) {
  if (value == null) return '-';
  if (Number.isInteger(value)) return String(value);
  return String(Number(value.toPrecision(4)));
}

/** A number beside an axis. */
export function tick(value) {
  return Math.abs(value) < 1e5 ? String(Number(value.toPrecision(3))) :
                                 value.toExponential().replace('e+', 'e');
}

/** Running sums over the series; what has no value adds nothing. */
export function stackedSums(rows) {
  const sums = [];
  for (const row of rows) {
    const below = sums[sums.length - 1];
    sums.push(row.map((value, i) => (value ?? 0) + (below ? below[i] : 0)));
  }
  return sums;
}

/** Draws marks: frames in which a surface was lost, costs that diverged. */
function drawMarks(plot, places) {
  const {ctx, bbox} = plot;
  ctx.save();
  ctx.strokeStyle = '#dd000080';
  ctx.lineWidth = devicePixelRatio;
  for (const place of places) {
    const x = plot.valToPos(place, 'x', true);
    if (x < bbox.left || x > bbox.left + bbox.width) continue;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
  }
  ctx.restore();
}

/** Vertical bars over the values, as wide as their spread. */
function drawSpreads(plot, series) {
  const {ctx} = plot;
  ctx.save();
  ctx.lineWidth = devicePixelRatio;
  series.forEach((one, s) => {
    ctx.strokeStyle = plot.series[s + 1].stroke(plot, s + 1);
    (one.spread ?? []).forEach((spread, i) => {
      if (spread == null || one.values[i] == null) return;
      const x = plot.valToPos(plot.data[0][i], 'x', true);
      ctx.beginPath();
      ctx.moveTo(x, plot.valToPos(one.values[i] - spread, 'y', true));
      ctx.lineTo(x, plot.valToPos(one.values[i] + spread, 'y', true));
      ctx.stroke();
    });
  });
  ctx.restore();
}

/** uPlot's options of a chart that is `width` pixels wide. */
function optionsOf(chart, colors, width, group) {
  const stroke = () => getComputedStyle(document.body).color;
  const grid = {stroke: '#8883', width: 1};
  const names = chart.x_names;
  const axes = [
    {stroke, grid, ticks: grid, font: '11px sans-serif', size: 30},
    {stroke, grid, ticks: grid, font: '11px sans-serif', size: 64,
     values: (plot, places) => places.map(tick)},
  ];
  if (names) {
    axes[0].splits = () => names.map((_, i) => i);
    axes[0].values = (plot, places) => places.map(i => names[i] ?? '');
  }
  // Areas lie over one another: the whole first, its parts over it.
  const order = chart.series.map((_, s) => s);
  if (chart.stacked) order.reverse();
  const series = order.map(s => {
    const color = colors[s % colors.length];
    return {
      label: chart.series[s].name,
      stroke: color,
      fill: chart.stacked ? color : undefined,
      width: chart.stacked ? 0 : 1.5,
      points: {show: names ? true : undefined, size: 5},
      value: (plot, _, i, at) =>
          rounded(at == null ? null : chart.series[s].values[at]),
    };
  });
  // Error bars belong to what is seen.
  const ends = sign => chart.series.flatMap(
      ({values, spread = []}) => values
          .map((value, i) => value == null ? null :
                                            value + sign * (spread[i] ?? 0))
          .filter(value => value != null));
  const top = Math.max(...ends(1)), bottom = Math.min(...ends(-1));
  const marks = chart.marks.map(i => chart.x[i]);
  return {
    width, height: 190, title: chart.title,
    scales: {x: {time: false, range: names ? [-.5, names.length - .5] : null},
             y: {range: (plot, low, high) => names ?
                 uPlot.rangeNum(bottom, Math.max(high, top), .1, false) :
                 [Math.min(0, low), high * 1.05 || 1]}},
    axes,
    legend: {live: true},
    series: [{label: chart.x_title,
              value: (plot, x) =>
                  x == null ? '-' : names ? names[x] : rounded(x)}, ...series],
    cursor: {y: false, sync: {key: group, scales: ['x', null]},
             drag: {x: true, y: false}},
    hooks: {setScale: [(plot, scale) => {
      const {min, max} = plot.scales.x;
      if (scale === 'x') ranges.set(group, {min, max});
    }],
            draw: [plot => drawMarks(plot, marks),
                   plot => drawSpreads(plot, chart.series)]},
  };
}

/** uPlot's rows of a chart: places, and what is drawn over them. */
function rowsOf(chart) {
  const rows = chart.series.map(series => series.values);
  return [chart.x, ...(chart.stacked ? stackedSums(rows).reverse() : rows)];
}

/** Moves the cursor to the position nearest to a place on the axis. */
function setCursor(plot, place) {
  plot.setCursor({left: plot.valToPos(place, 'x'), top: 0}, false);
}

/** Charts that were drawn, by group: they are zoomed together. */
const drawn = new Map();

/** What is shown of the axis in all charts of a group. */
const ranges = new Map();

function setRange(group, range) {
  for (const plot of drawn.get(group)) plot.setScale('x', range);
}

/** Zooms about the cursor, or the middle. */
function zoom(plot, factor, group) {
  const {min, max} = plot.scales.x;
  const at = plot.cursor.idx == null ? (min + max) / 2 :
                                       plot.data[0][plot.cursor.idx];
  const [first, last] = [plot.data[0][0], plot.data[0].at(-1)];
  setRange(group, {min: Math.max(at - (at - min) * factor, first),
                   max: Math.min(at + (max - at) * factor, last)});
}

/** Shows all there is. */
function unzoom(group) {
  for (const {data: [x], setScale} of drawn.get(group)) {
    setScale('x', {min: x[0], max: x[x.length - 1]});
  }
}

/** What keys do: left and right the next position, + and - zoom, Escape all. */
function onKey(event, plot, group, show) {
  const x = plot.data[0];
  const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
  if (step) {
    const at = plot.cursor.idx == null ? 0 : plot.cursor.idx + step;
    const place = x[Math.min(Math.max(at, 0), x.length - 1)];
    setCursor(plot, place);
    show(place);
  } else if (event.key === '+' || event.key === '=') {
    zoom(plot, 1 / 2, group);
  } else if (event.key === '-') {
    zoom(plot, 2, group);
  } else if (event.key === 'Escape') {
    unzoom(group);
  } else {
    return;
  }
  event.preventDefault();
}

/** Draws a chart into its figure. */
function draw(figure, chart, colors) {
  const place = figure.querySelector('.plot');
  figure.classList.add('drawn');
  const range = ranges.get(chart.group);  // Of those that were drawn before.
  const plot = new uPlot(
      optionsOf(chart, colors, place.clientWidth, chart.group), rowsOf(chart),
      place);
  figure.plot = plot;
  drawn.set(chart.group, [...(drawn.get(chart.group) ?? []), plot]);
  if (range) plot.setScale('x', range);
  const show = x => chart.frames && showFrame(chart.group, x, figure);
  new ResizeObserver(() => {
    if (place.clientWidth > 0) {
      plot.setSize({width: place.clientWidth, height: 190});
    }
  }).observe(place);
  figure.addEventListener(
      'keydown', event => onKey(event, plot, chart.group, show));
  plot.over.addEventListener('dblclick', () => unzoom(chart.group));
  plot.over.addEventListener('click', () => {
    if (plot.cursor.idx != null) show(plot.data[0][plot.cursor.idx]);
  });
  if (chart.frames) {
    onFrame(chart.group, figure, frame => setCursor(plot, frame));
  }
  matchMedia('(prefers-color-scheme: dark)')
      .addEventListener('change', () => plot.redraw());
}

/** The charts of the page's data, with their places filled in. */
function readCharts() {
  const data = JSON.parse(document.getElementById('charts').textContent);
  for (const chart of data.charts) chart.x = data.places[chart.x];
  return data;
}

// Charts are drawn when they come near: there may be hundreds.
const data = readCharts();
const observer = new IntersectionObserver(entries => {
  for (const {target, isIntersecting} of entries) {
    if (!isIntersecting) continue;
    observer.unobserve(target);
    draw(target, data.charts[target.dataset.chart], data.colors);
  }
}, {rootMargin: '400px'});
for (const figure of document.querySelectorAll('figure.chart')) {
  observer.observe(figure);
}
window.splitfusion = {...window.splitfusion, charts: data.charts};
