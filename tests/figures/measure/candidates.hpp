// Operations of one thread, measured in turns: the rounds of all are interleaved at random, so that
// disturbances affect all alike; and each runs once under callgrind, which counts instructions.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tappet::figures {

/// A repeatable operation. `run(n)` executes it n times; it keeps its own data (static storage).
struct Candidate {
    std::string name;
    Standing role = Standing::ours;
    void (*run)(std::size_t times) = nullptr;
    /// Called before each sample of `times`, neither timed nor counted: it undoes run(). Null: nothing to do.
    void (*prepare)(std::size_t times) = nullptr;
};

/// In the median `ours` takes at most `times` the sum of the named candidates of the same group.
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
    std::size_t batch = 64; ///< operations in one sample: enough to hide the cost of reading the clock
    std::vector<Candidate> candidates = {};
    std::vector<RatioGoal> goals = {};
};

/// Keeps the compiler from removing or moving the computation of `value`.
template <class T>
inline void keep(T& value) noexcept {
    asm volatile("" : "+m"(value) : : "memory");
}
/// Tells the compiler that all memory may have changed.
inline void clobber() noexcept { asm volatile("" : : : "memory"); }

/// The options of every program of figures:
///     --json FILE   --long   --smoke (a tenth of a second, for tests)   --only TEXT (groups whose id has it)
///     --brief (a fifth of the short setting, for the rounds in which two commits alternate)   --no-counts
struct Options {
    std::string json = {};
    std::string only = {};
    std::string setting = "short"; ///< short, long, brief, smoke
    bool counts = true;
    [[nodiscard]] bool wants(std::string_view id) const { return id.contains(only); }
    /// Factor on the work of the short setting.
    [[nodiscard]] double scale() const {
        return setting == "long" ? 10 : setting == "brief" ? 0.2 : setting == "smoke" ? 0.02 : 1;
    }
};
/// `own`: additional words of this program that take a value, and the destination of each. Exits with 2 and a
/// sentence when a word is wrong.
Options read_options(int argc, char** argv, const std::map<std::string, std::string*>& own = {});

/// Runs the selected groups and adds figures and goals to the result. A ratio is the median of the ratios of
/// all rounds. Call it once, early: under callgrind this same program is started again, and exits from within
/// this call.
void run_candidates(const Options& options, char** argv, const std::vector<Group>& groups, Result& result);

/// Returns whether this process runs under callgrind.
bool counting();

/// Prints the result and writes it to options.json. Returns the program's exit code: 0 measured (goals held
/// or not), 1 not written.
int finish(const Options& options, const Result& result);

} // namespace tappet::figures
