// How the page looks, by day and by night.
#pragma once

#include <string_view>

namespace tappet::figures {

inline constexpr std::string_view style = R"css(
:root { color-scheme: light dark; --ink: #1c2127; --soft: #5c6670; --line: #dde1e6; --paper: #ffffff; --shade: #f5f7f9;
  --good: #17803d; --bad: #c0262d; --ours: #2b7de0; --floor: #8a9099; --peer: #e5832a; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e8ec; --soft: #9aa4ae; --line: #333a42; --paper: #14181c; --shade: #1c2127;
  --good: #4cc26f; --bad: #ff7a7a; --ours: #6aa9f5; } }
* { box-sizing: border-box; }
html { scroll-behavior: smooth; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
main, header, nav { max-width: 68rem; margin: 0 auto; padding: 0 1.25rem; }
header { padding-top: 2.5rem; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .25rem; character-spacing: -.01em; }
h2 { font-size: 1.4rem; margin: 3.5rem 0 .5rem; padding-top: .5rem; border-top: 2px solid var(--ink); }
h3 { font-size: 1.02rem; margin: 2rem 0 .1rem; }
p { margin: .4rem 0; max-width: 46rem; }
.soft, .how { color: var(--soft); }
.how { font-size: .85rem; margin: 0 0 .35rem; }
nav ul { list-style: none; display: flex; flex-wrap: wrap; gap: .25rem 1.25rem; padding: .6rem 0; margin: 1rem 0 0;
  border-top: 1px solid var(--line); border-bottom: 1px solid var(--line); }
a { color: var(--ours); text-decoration: none; } a:hover { text-decoration: underline; }
.score { display: flex; flex-wrap: wrap; gap: 1rem; margin: 1.25rem 0; }
.score div { background: var(--shade); border-radius: .5rem; padding: .7rem 1.1rem; min-width: 9rem; }
.score b { display: block; font-size: 1.6rem; line-height: 1.2; font-variant-numeric: tabular-nums; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .88rem; font-variant-numeric: tabular-nums; }
th { text-align: right; font-weight: 600; color: var(--soft); padding: .25rem .6rem; border-bottom: 1px solid var(--line); white-space: nowrap; }
td { text-align: right; padding: .28rem .6rem; border-bottom: 1px solid var(--line); white-space: nowrap; vertical-align: top; }
th:first-child, td:first-child, td.words, th.words { text-align: left; }
td.words, td:first-child { white-space: normal; }
td:first-child { padding-left: 0; min-width: 12rem; } td.held, td.missed { min-width: 0; width: 4.5rem; }
tr.ours td { font-weight: 600; background: var(--shade); } tr.ours td:first-child { padding-left: .4rem; }
tr.beside td { max-width: 0; text-align: left; padding: 0 0 .4rem 1.6rem; font-size: .83rem; color: var(--soft); background: var(--shade); white-space: normal; }
.words + .words { min-width: 18rem; } td.held + .words, td.missed + .words { min-width: 18rem; }
tr.joined td { border-bottom: 0; }
tr.beside b { color: var(--ink); font-weight: 600; } tr.beside span { white-space: nowrap; margin-right: 1.1rem; }
.role { display: inline-block; width: .62rem; height: .62rem; border-radius: 50%; margin-right: .5rem; }
.role.ours { background: var(--ours); } .role.floor { background: var(--floor); } .role.peer { background: var(--peer); }
.held { color: var(--good); font-weight: 600; } .missed { color: var(--bad); font-weight: 600; }
.detail { display: block; font-size: .8rem; color: var(--soft); font-weight: 400; }
.bar { position: relative; display: inline-block; width: 8rem; height: .7rem; background: var(--line); border-radius: .35rem; overflow: hidden; vertical-align: middle; }
.bar i { position: absolute; left: 0; top: 0; bottom: 0; background: var(--good); } .bar.over i { background: var(--bad); }
.bar u { position: absolute; left: 50%; top: 0; bottom: 0; width: 2px; background: var(--ink); }
.failure { border-left: 4px solid var(--bad); background: var(--shade); padding: .5rem 1rem; margin: .8rem 0; }
pre { overflow-x: auto; font-size: .8rem; margin: .3rem 0; white-space: pre-wrap; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(28rem, 100%), 1fr)); gap: 1rem 1.5rem; margin: 1rem 0; }
figure { margin: 0; } figcaption { font-size: .88rem; font-weight: 600; margin-bottom: .2rem; }
figure svg { width: 100%; height: auto; display: block; color: var(--ink); }
details { margin: 1rem 0; } summary { cursor: pointer; font-weight: 600; padding: .4rem 0; border-bottom: 1px solid var(--line); }
ul.notes li { max-width: 46rem; }
footer { margin: 4rem auto 2rem; max-width: 68rem; padding: 0 1.25rem; color: var(--soft); font-size: .85rem; }
@media print { nav { display: none; } h2 { break-after: avoid; } table, figure { break-inside: avoid; } }
)css";

} // namespace tappet::figures
