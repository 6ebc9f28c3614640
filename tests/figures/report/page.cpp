// Writes the page from its top to its end.
#include "tests/figures/report/page.hpp"

#include "tests/figures/report/plots.hpp"
#include "tests/figures/report/sections.hpp"
#include "tests/figures/report/style.hpp"
#include "tests/figures/report/tables.hpp"
#include "tests/figures/report/text.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tappet::figures {

namespace {

/// A machine is called restless when the time of its fixed work varies by more than this.
constexpr double quiet_percent = 2;

/// Programs in the order of the sections; those without a section come last.
std::vector<const ProgramRun*> in_order(const Run& run) {
    std::vector<const ProgramRun*> programs;
    for (const ProgramRun& program : run.programs) programs.push_back(&program);
    std::ranges::sort(programs, {}, [](const ProgramRun* program) {
        return std::pair{std::ranges::find(sections, program->name, &Section::program) - sections.begin(),
                         program};
    });
    return programs;
}
std::string title_of(const std::string& program) {
    const auto found = std::ranges::find(sections, program, &Section::program);
    return found == sections.end() ? program : std::string{found->title};
}

std::string goals(const Run& run) {
    std::string held, missed;
    for (const ProgramRun* program : in_order(run))
        for (const Goal& goal : program->result.goals) (goal.held() ? held : missed) += goal_row(goal, run);
    if (held.empty() && missed.empty()) return {};
    return "<h2 id=\"goals\">Goals</h2><p class=\"soft\">Ratios of one run on one machine, the missed ones "
           "first. The mark in a "
           "bar's middle is the limit; the bar ends at twice of it.</p><div class=\"wide\"><table><tr><th>"
           "</th><th class=\"words\">goal</th><th>measured</th><th>at most</th><th></th></tr>" +
           missed + held + "</table></div>";
}

std::string failure(const ProgramRun& program) {
    if (program.failure.empty()) return {};
    const auto end = program.failure.find('\n');
    return element(
        "div",
        element("b", "figures-" + escaped(program.name) + " " + escaped(program.failure.substr(0, end))) +
            (end == std::string::npos ? "" : element("pre", escaped(program.failure.substr(end + 1)))),
        "class=\"failure\"");
}

std::string plots(const Result& result, const std::map<const Plot*, std::string>& drawn) {
    std::string all;
    for (const Plot& plot : result.plots)
        if (const auto found = drawn.find(&plot); found != drawn.end() && !found->second.empty())
            all += element("figure", element("figcaption", escaped(plot.title)) + found->second);
    return all.empty() ? "" : element("div", all, "class=\"plots\"");
}

std::string notes(const Result& result) {
    std::string all;
    for (const std::string& note : result.notes) all += element("li", escaped(note));
    return all.empty() ? "" : "<h3>Notes</h3>" + element("ul", all, "class=\"notes\"");
}

std::string section(const ProgramRun& program, const std::map<const Plot*, std::string>& drawn) {
    const auto found = std::ranges::find(sections, program.name, &Section::program);
    std::string text = element("h2", escaped(title_of(program.name)), "id=\"" + escaped(program.name) + "\"");
    if (found != sections.end()) text += element("p", std::string{found->about});
    return text + failure(program) + statements(program.result) + plots(program.result, drawn) +
           tables(program.result) + notes(program.result);
}

std::string noise_row(const std::string& when, const Noise& noise, const Usage* usage) {
    return element(
        "tr", element("td", escaped(when)) + cell(noise.spread_percent) + cell(noise.worst_percent) +
                  cell(noise.gaps_per_second) + cell(noise.longest_gap_us) + cell(noise.lost_percent) +
                  (usage == nullptr ? "<td></td><td></td><td></td><td></td>"
                                    : cell(usage->seconds) + cell(usage->busy_percent) +
                                          cell(usage->steal_percent) + cell(usage->switches_per_second)));
}
std::string machine(const Run& run) {
    std::string rows, noises = noise_row("before", run.before, nullptr);
    for (const auto& [what, value] : run.machine)
        rows +=
            element("tr", element("td", escaped(what)) + element("td", escaped(value), "class=\"words\""));
    for (const ProgramRun& program : run.programs)
        noises += noise_row(program.name, program.after, &program.usage);
    return "<h2 id=\"machine\">The machine and its noise</h2><div class=\"wide\"><table>" + rows +
           "</table></div><h3>Noise</h3><p class=\"how\">The same work of about 25 us, again and again on "
           "one processor at "
           "SCHED_FIFO: how far its p99 and its longest lie above its median; and a look at the clock "
           "without pause: how often "
           "something took more than 1 us away. Taken before the run and after each program; what the whole "
           "machine did during "
           "the program stands beside it.</p><div class=\"wide\"><table><tr><th>when</th><th>p99 above "
           "median, %</th><th>max above, "
           "%</th><th>pauses/s</th><th>longest, us</th><th>lost, %</th><th>ran, s</th><th>busy, "
           "%</th><th>stolen, "
           "%</th><th>switches/s</th></tr>" +
           noises + "</table></div>";
}

double worst_spread(const Run& run) {
    double worst = run.before.spread_percent;
    for (const ProgramRun& program : run.programs) worst = std::max(worst, program.after.spread_percent);
    return worst;
}
std::string noise_sentence(const Run& run) {
    const double worst = worst_spread(run);
    return "Fixed work varied by up to " + number_text(worst) + " % (p99 above median) on this machine" +
           (worst > quiet_percent ? ": a restless one. Trust the ratios and the instructions; a difference "
                                    "of a few per cent means nothing here."
                                  : ": a quiet one.");
}

std::string scores(const Run& run) {
    const Score s = score(run);
    const auto box = [](const std::string& number, const std::string& what) {
        return element("div", element("b", number) + what);
    };
    std::string all = box(std::to_string(s.held) + " of " + std::to_string(s.goals), "goals held");
    if (s.statements != 0)
        all += box(std::to_string(s.true_ones) + " of " + std::to_string(s.statements), "statements true");
    all += box(std::to_string(s.programs - s.failed) + " of " + std::to_string(s.programs),
               "programs ran to their end");
    return element("div", all, "class=\"score\"");
}

} // namespace

std::string page(const Run& run, const std::string& folder) {
    std::vector<const Plot*> all;
    for (const ProgramRun& program : run.programs)
        for (const Plot& plot : program.result.plots) all.push_back(&plot);
    std::map<const Plot*, std::string> drawn;
    std::string undrawn;
    if (!all.empty()) {
        auto elements = draw(all, folder);
        if (!elements) undrawn = element("div", escaped(elements.error()), "class=\"failure\"");
        for (std::size_t i = 0; elements && i < all.size(); ++i) drawn[all[i]] = std::move((*elements)[i]);
    }
    std::string contents = "<li><a href=\"#goals\">Goals</a></li>", body;
    for (const ProgramRun* program : in_order(run)) {
        const std::string title = title_of(program->name);
        contents += "<li><a href=\"#" + escaped(program->name) + "\">" +
                    escaped(title.substr(0, title.find(':'))) + "</a></li>";
        body += section(*program, drawn);
    }
    contents += "<li><a href=\"#machine\">The machine</a></li>";
    std::string failures;
    for (const ProgramRun& program : run.programs) failures += failure(program);
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
           "content=\"width=device-width, initial-scale=1\"><title>Tappet: the figures</title><style>" +
           std::string{style} +
           "</style></head>\n<body><header><h1>Tappet: the figures</h1><p class=\"soft\">" +
           escaped(run.when) + ", " + escaped(run.setting) + " setting, commit " + escaped(run.commit) +
           "</p>" + scores(run) +
           "<p>Each figure shows what Tappet takes <b>(ours)</b> beside its <b>floors</b>, the physical or "
           "the bare limit of the same "
           "task, and its <b>peers</b>, what others offer for it, all measured in turns in one run. Times "
           "differ from machine to "
           "machine; the ratios are the figures. " +
           escaped(noise_sentence(run)) + "</p></header><nav><ul>" + contents + "</ul></nav>\n<main>" +
           failures + undrawn + goals(run) + body + machine(run) +
           "</main><footer>Made by ci/figures. The merged JSON beside this page holds every number of "
           "it.</footer></body></html>\n";
}

std::string summary_text(const Run& run) {
    std::string text;
    const auto line = [&](const std::string& words) { text += words + "\n"; };
    const auto padded = [](std::string word, std::size_t width) {
        word.resize(std::max(width, word.size()), ' ');
        return word;
    };
    for (const bool held : {false, true})
        for (const ProgramRun* program : in_order(run))
            for (const Goal& goal : program->result.goals)
                if (goal.held() == held)
                    line(std::string{held ? "  held    " : "  MISSED  "} +
                         padded(quantity(goal.measured, goal.unit), 12) +
                         padded("(<= " + quantity(goal.limit, goal.unit) + ")", 16) + goal.text);
    for (const ProgramRun* program : in_order(run))
        for (const Statement& each : program->result.statements)
            if (!each.held) line("  FALSE   " + each.text + ": " + each.measured);
    for (const ProgramRun& program : run.programs)
        if (!program.failure.empty())
            line("  FAILED  figures-" + program.name + " " +
                 program.failure.substr(0, program.failure.find('\n')));
    const Score s = score(run);
    line("\n" + std::to_string(s.held) + " of " + std::to_string(s.goals) + " goals held, " +
         std::to_string(s.true_ones) + " of " + std::to_string(s.statements) + " statements true, " +
         std::to_string(s.failed) + " of " + std::to_string(s.programs) + " programs failed");
    line(noise_sentence(run));
    return text;
}

} // namespace tappet::figures
