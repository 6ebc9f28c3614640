// Runs the script of the figures' page on a document that only keeps its elements.
// node page_test.js report.html; exit code 1: a check failed.
"use strict";
const assert = require("node:assert/strict");
const fs = require("node:fs");

class Node {
  constructor(name) { Object.assign(this, {name, attributes: {}, children: []}); }
  setAttribute(what, value) { this.attributes[what] = String(value); }
  set className(value) { this.attributes.class = value; }
  append(...more) { this.children.push(...more); }
  get text() { return this.children.map(each => typeof each === "string" ? each : each.text).join(""); }
  all(name) { return this.children.flatMap(each => each instanceof Node ? [...(each.name === name ? [each] : []), ...each.all(name)] : []); }
}
const script = fs.readFileSync(process.argv[2], "utf8").match(/<script>([\s\S]*?)<\/script>/)[1];
function shown(programs, machine = []) {
  const body = new Node("body");
  const noise = {spread_percent: 1, worst_percent: 1, gaps_per_second: 0, longest_gap_us: 0, lost_percent: 0};
  const run = {commit: "abc", when: "today", setting: "short", machine, noise_before: noise,
    programs: programs.map(each => ({failure: "", usage: {}, noise_after: noise, ...each,
      result: {figures: [], goals: [], statements: [], plots: [], notes: [], ...each.result}}))};
  const document = {createElementNS: (_, name) => new Node(name), querySelector: () => body,
    getElementById: () => ({textContent: JSON.stringify(run)})};
  new Function("document", script)(document);
  return body;
}
const row = (name, role, median) => ({name, role, median, mean: median, p99: median * 2, p999: median * 3, max: median * 4, count: 100});
const write = (id = "exchange.write", more = {}) => ({id, title: "a write", unit: "ns", source: "thesis 4.4", how: "mean of 64",
  rows: [row("port", "ours", 12), row("copy", "floor", 10), row("mutex", "peer", 40)], ...more});
const contains = (body, ...texts) => texts.forEach(text => assert.ok(body.text.includes(text), `${text} is not in: ${body.text}`));

// Ours stands beside its floor and its peer as ratios.
contains(shown([{name: "exchange", result: {figures: [write()]}}]), "exchange.write", "1.20 x copy (p99 1.20 x)", "0.30 x mutex");
// A floor of one row of ours is compared with that row alone.
contains(shown([{name: "f", result: {figures: [write("f", {rows: [row("high, one", "ours", 20), row("high, its load", "floor", 10),
  row("low", "ours", 60), row("low, its load", "floor", 30), row("mutex", "peer", 40)]})]}}]),
  "2.00 x high, its load (p99 2.00 x) 0.50 x mutex", "2.00 x low, its load (p99 2.00 x) 1.50 x mutex");
// A single measurement has no quantiles.
const single = shown([{name: "f", result: {figures: [write("f", {rows: [row("a", "ours", 12), row("b", "floor", 10)].map(each => ({...each, count: 1}))})]}}]);
assert.ok(single.all("th").some(each => each.text === "value") && !single.text.includes("p99.9"));
contains(single, "1.20 x b ");
// Missed goals come first, one without a number is missed, and a detail links to its figure.
const goal = (text, measured, detail = "") => ({text, limit: 1.2, measured, unit: "x", detail});
const goals = shown([{name: "exchange", result: {figures: [write()],
  goals: [goal("is short", 1.1, "exchange.write: port / copy"), goal("is lean", 3), goal("is something", null)]}}]);
contains(goals, "1 of 3goals held", "missedis something");
assert.ok(goals.text.indexOf("is lean") < goals.text.indexOf("is short"));
assert.ok(goals.all("a").some(each => each.text === "exchange.write" && each.attributes.href === "#exchange.write"));
// Failures say what happened, statements whether they hold.
contains(shown([{name: "scale", failure: "ended with exit code 3\nno <compiler>"}]), "figures-scale ended with exit code 3", "no <compiler>", "0 of 1programs ran");
contains(shown([{name: "scope", result: {statements: [{text: "it waits", held: false, measured: "8 us"}]}}]), "0 of 1statements true", "falseit waits8 us");
// Text of a program becomes text: nothing on the page is parsed as HTML.
assert.ok(!/innerHTML|insertAdjacentHTML|outerHTML|document\.write/.test(script));
// Many figures are folded by the prefix of their ids.
const many = shown([{name: "x", result: {figures: Array.from({length: 30}, (_, i) => write(`x.${i % 2 ? "large" : "small"}.${i}`))}}]);
assert.equal(many.all("details").length, 2);
assert.equal(many.all("h3").filter(each => each.attributes.id?.startsWith("x.")).length, 30);
// Points that an axis cannot show are left out; without a point there is no plot; an empty bin is below one.
const plot = (points, more = {}) => ({id: "p", title: "a plot", x: "x", y: "y", histogram: false, log_x: true, log_y: true,
  series: [{name: "it's", role: "ours", points}], ...more});
const drawn = (...given) => shown([{name: "x", result: {plots: [plot(...given)]}}]);
assert.equal(drawn([[0, 1], [1, 0], [null, 1], [7, 5]]).all("circle").length, 1);
assert.equal(drawn([[0, 1], [1, 0]]).all("svg").length, 0);
const bins = drawn([[1, 3], [2, 0], [4, 9]], {histogram: true, log_x: false});
assert.equal(bins.all("svg")[0].attributes["aria-label"], "a plot");
for (const path of bins.all("path")) assert.ok(!/NaN|Infinity|undefined/.test(path.attributes.d), path.attributes.d);
contains(shown([{name: "x"}], [["processor", "fast"]]), "processorfast");
