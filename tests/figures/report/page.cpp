// The page shows the JSON by its own script; only the summary is written here.
#include "tests/figures/report/page.hpp"

#include "tests/figures/report/text.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace tappet::figures {

namespace {

/// A machine is called restless when the time of its fixed work varies by more than this.
constexpr double quiet_percent = 2;

std::string padded(std::string word, std::size_t width) {
    word.resize(std::max(width, word.size()), ' ');
    return word;
}
std::string noise_sentence(const Run& run) {
    double worst = run.before.spread_percent;
    for (const ProgramRun& program : run.programs) worst = std::max(worst, program.after.spread_percent);
    return "Fixed work varied by up to " + number_text(worst) + " % (p99 above median) on this machine" +
           (worst > quiet_percent ? ": a restless one. Trust the ratios and the instructions; a difference "
                                    "of a few per cent means nothing here."
                                  : ": a quiet one.");
}

} // namespace

std::expected<std::string, std::string> page(const std::string& merged_run) {
    std::ifstream file{TAPPET_FIGURES_PAGE};
    std::string page{std::istreambuf_iterator<char>{file}, {}};
    const std::string place = "@run@";
    const auto at = page.find(place);
    if (at == page.npos)
        return std::unexpected(std::string{TAPPET_FIGURES_PAGE} + " is missing, or has no " + place +
                               " where the run belongs");
    std::string data; // a "<" of a text must not end the page's element
    for (const char character : merged_run) character == '<' ? data += "\\u003c" : data += character;
    return page.replace(at, place.size(), data);
}

std::string summary_text(const Run& run) {
    std::string text;
    const auto line = [&](const std::string& words) { text += words + "\n"; };
    for (const bool held : {false, true})
        for (const ProgramRun& program : run.programs)
            for (const Goal& goal : program.result.goals)
                if (goal.held() == held)
                    line(std::string{held ? "  held    " : "  MISSED  "} +
                         padded(quantity(goal.measured, goal.unit), 12) +
                         padded("(<= " + quantity(goal.limit, goal.unit) + ")", 16) + goal.text);
    for (const ProgramRun& program : run.programs)
        for (const Statement& each : program.result.statements)
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
