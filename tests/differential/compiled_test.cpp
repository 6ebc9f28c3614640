// Generated scripts that the C++ compiler has turned into native code do what their text says, step by step,
// as the second interpreter reads it (thesis 5.1, 5.2). TAPPET_SEED chooses other days.
#include "tests/differential/random_day.hpp"

#include "kernel/machine/table/compiled.hpp"
#include "kernel/script/compiled.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace tappet {

struct Compiled {
    std::string_view text{};
    const CompiledBehaviour* behaviour = nullptr;
};

inline constexpr auto bench_reach = [] {
    auto reach =
        script_reach(reachable<Bench>("own"), reachable<Bench>("mate"), reachable<Arm>("arm", false));
    reach.statements_per_step = 100'000;
    return reach;
}();

} // namespace tappet

#include "tests/differential/generated_scripts.hpp"

namespace tappet {
namespace {

TEST(A_compiled_script, does_what_its_text_says_step_by_step) {
    const char* const given = std::getenv("TAPPET_SEED");
    const std::uint64_t seed = given == nullptr ? 1 : std::strtoull(given, nullptr, 10);
    for (const Compiled& each : all_scripts) {
        std::vector<ProgramCode> code;
        std::vector<StateMachineFast> fast;
        for (const BehaviourCode& type : each.behaviour->code) {
            code.push_back(type.code);
            fast.push_back(type.fast);
        }
        for (std::uint64_t day = 0; day < 40; ++day) {
            RandomDay random{seed * 1000 + day, std::string{each.text}, *each.behaviour->script, code, fast};
            const std::string difference = random.run(60);
            ASSERT_TRUE(difference.empty()) << "day " << day << "\n" << difference << each.text;
        }
    }
}

} // namespace
} // namespace tappet
