// Any bytes as a script: the firmware's compiler refuses them with a place in the text, or makes tables that
// may be executed; both in bounded time and in the given room.
#include "tests/differential/unit_bench.hpp"

#include "kernel/script/compile.hpp"
#include "tests/fuzz/input.hpp"

#include <memory>
#include <string_view>

namespace {

using namespace tappet;
using tappet::fuzz::demand;

constexpr ScriptSizes capacity = script_sizes_for(400, 8000, 3);

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string_view text{reinterpret_cast<const char*>(bytes), size};
    static const auto rows = std::make_unique<ScriptBuffer<capacity>>();
    Reach reach;
    reach.components = UnitBench::reach();
    // Some machines allow loops that run without waiting, some do not.
    reach.statements_per_step = size % 2 == 0 ? 1000 : 0;
    const ScriptOutcome outcome = compile_into(text, "fuzz.osd", reach, rows->room());
    if (!outcome.good()) {
        demand(outcome.fault.view().starts_with("fuzz.osd:"));
        demand(outcome.fault.size() <= Sentence::capacity);
        return 0;
    }
    UnitBench bench;
    bench.place(outcome.unit);
    bench.start();
    for (int i = 0; i < 8; ++i) {
        bench.now += Duration{20'000'000};
        bench.source.write(i);
        bench.step();
        bench.step_arm();
        bench.own.tick();
        bench.own.moved(i, 0.5);
        bench.own.switched(i % 2 == 0);
    }
    return 0;
}
