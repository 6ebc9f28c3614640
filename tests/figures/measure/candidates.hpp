// Operations of one thread, measured in turns: each is run in rounds that are interleaved at random, so that
// whatever the machine does meanwhile meets all of them alike; and once under callgrind, which counts
// instructions.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tappet::figures {

/// Something that can be done again and again. `run(n)` does it n times; what it works on it keeps itself
/// (static storage).
struct Candidate {
    std::string name;
    Standing role = Standing::ours;
    void (*run)(std::size_t times) = nullptr;
    /// Before each sample of `times`, neither timed nor counted: it takes back what run() did. Null: nothing.
    void (*prepare)(std::size_t times) = nullptr;
};

/// In the median `ours` takes at most `times` what the named candidates of the same group take together.
struct RatioGoal {
    std::string text;
    std::string ours;
    double times = 1;
    std::vector<std::string> of = {};
};

/// Candidates that do the same.
struct Group {
    std::string id; ///< of the figure
    std::string title;
    std::string source = {};
    std::size_t batch = 64; ///< operations in one sample: so many that reading the clock is lost among them
    std::vector<Candidate> candidates = {};
    std::vector<RatioGoal> goals = {};
};

/// Keeps the compiler from leaving out or moving what `value` is needed for.
template <class T>
inline void keep(T& value) noexcept {
    asm volatile("" : "+m"(value) : : "memory");
}
/// All memory may have changed.
inline void clobber() noexcept { asm volatile("" : : : "memory"); }

/// What a program is told:
///     --json FILE   --long   --smoke (a tenth of a second, for tests)   --only TEXT (groups whose id has it)
///     --brief (a fifth of the short setting, for the rounds in which two commits alternate)   --no-counts
struct Options {
    std::string json = {};
    std::string only = {};
    std::string setting = "short"; ///< short, long, brief, smoke
    bool counts = true;
    [[nodiscard]] bool wants(std::string_view id) const { return id.contains(only); }
    /// So many times what the short setting does.
    [[nodiscard]] double scale() const {
        return setting == "long" ? 10 : setting == "brief" ? 0.2 : setting == "smoke" ? 0.02 : 1;
    }
};
/// `own`: words of this program alone that take a value, and where it goes. Exits with 2 and a sentence when
/// a word is wrong.
Options read_options(int argc, char** argv, const std::map<std::string, std::string*>& own = {});

/// Runs the groups that are wanted and adds figures and goals to the result. A ratio is the median of the
/// ratios of all rounds. Call it once, early: under callgrind this same program is started again, and leaves
/// from within this call.
void run_candidates(const Options& options, char** argv, const std::vector<Group>& groups, Result& result);

/// Whether this process is the one under callgrind.
bool counting();

/// Prints the result, writes it where options.json says. The program's exit code: 0 measured (goals held or
/// not), 1 not written.
int finish(const Options& options, const Result& result);

} // namespace tappet::figures
