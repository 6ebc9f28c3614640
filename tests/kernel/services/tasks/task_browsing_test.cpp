// Browsers see, set and command behaviours as tasks in the same way, whether a script is compiled with the
// machine or loaded into its slot (thesis 4.8, 5.1.6, 5.2.5).
#include "kernel/script/compiled.hpp"
#include "kernel/services/tasks/behaviour_task.hpp"
#include "tests/kernel/services/browsing/press_rig.hpp"

#include <gmock/gmock.h>

namespace tappet::press {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr ScriptSource pressing_source{"pressing.osd", R"(
program int strokes(int wanted) {
    var int made = 0;
    while made < wanted { set made = made + 1; yield; }
    return made;
}
StateMachine Pressing {
    param double depth = 1.5
    var int counted = 0; var vector3 at; var text by = "nobody";
    initial state Up { transition arrived() select Down }
    state Down { entry { set counted = counted + 1; set at[0] = depth; } transition arrived() select Up }
    final state Safe { }
}
RootStateMachine Pressing cycle
)"};
constexpr auto pressing_reach = script_reach(reachable<Ram>("ram"));
constexpr const ScriptUnit& pressing = compiled_script<pressing_source, pressing_reach>;
using Cycle = BehaviourTask<pressing, "cycle">;
using Strokes = BehaviourTask<pressing, "strokes">;

// clang-format off
constexpr auto with_tasks = machine("press",
    components(component<Ram>("compiled"), component<Ram>("loaded"), component<Table>("table"), component<BrowserService>("browser", set("log", false)),
               component<Cycle>("compiled_cycle", controls("compiled")), component<Strokes>("compiled_strokes", controls("compiled")),
               component<Cycle>("loaded_cycle", controls("loaded")), component<Strokes>("loaded_strokes", controls("loaded"))),
    activities(
        activity("motion",  every(1ms), budget(50us), runs("compiled", "loaded", "compiled_cycle", "compiled_strokes", "loaded_cycle", "loaded_strokes")),
        activity("slow",    every(10ms), budget(50us), runs("table")),
        activity("browser", every(20ms), not_real_time, stack(256 * 1024), runs("browser"))),
    connections(data("table.height", "compiled.limit", stale_after(1s), hold), data("table.height", "loaded.limit", stale_after(1s), hold)),
    reactions(),
    behaviours(behaviour("compiled", pressing, {}),
               behaviour("loaded", slot(nodes(60), data_bytes(1024), depth(2), trial(1)))));
// clang-format on

class Task : public Browsed<with_tasks>, public testing::WithParamInterface<const char*> {
protected:
    std::string form = GetParam();

    void SetUp() override {
        Browsed::SetUp();
        if (form == "compiled") return;
        BehaviourSlot& slot = *instance.slot_of("loaded");
        EXPECT_EQ(compile(slot, pressing_source.text, "pressing.osd"), "");
        change(slot, BehaviourSlot::Change::take_over);
        run(5ms);
    }
    std::string ask(const std::string& request) { return Browsed::ask("1 " + request); }
    /// The end of a command.
    std::string follow(const std::string& command) {
        std::string answer = ask("send " + command);
        EXPECT_THAT(answer, HasSubstr(R"("state": "sent")"));
        while (!answer.empty() && answer.find("done") == std::string::npos &&
               answer.find("failed") == std::string::npos && answer.find("rejected") == std::string::npos)
            answer = next(talker());
        return answer;
    }
    void arrive() {
        the<Ram>(form).arrived.emit(1.0);
        run(5ms);
    }
};

TEST_P(Task, of_a_machine_has_its_variables_seen_and_set) {
    EXPECT_THAT(ask("set " + form + "_cycle.counted 5 " + form + "_cycle.depth 2.5"),
                HasSubstr(R"("set": 2)"));
    arrive();
    EXPECT_THAT(ask("get " + form + "_cycle.counted " + form + "_cycle.at " + form + "_cycle.by"),
                AllOf(HasSubstr("6"), HasSubstr("2.5"), HasSubstr("nobody")));
    EXPECT_THAT(ask("behaviours " + form + ".cycle"),
                AllOf(HasSubstr(R"("counted": 6)"), HasSubstr(R"("depth": 2.5)")));
    EXPECT_THAT(ask("set " + form + "_cycle.at \"[7, 8, 9]\""), HasSubstr(R"("set": 1)"));
    EXPECT_THAT(ask("behaviours " + form + ".cycle"), HasSubstr("[7, 8, 9]"));
    EXPECT_THAT(ask("set " + form + "_cycle.counted many"), HasSubstr("bad_value"));
}

TEST_P(Task, of_a_machine_is_commanded_and_queried) {
    EXPECT_THAT(follow(form + "_cycle.request Sefe"), HasSubstr("rejected"));
    EXPECT_THAT(ask("call " + form + "_cycle.is_in Up"), HasSubstr("\"result\": true"));
    EXPECT_THAT(follow(form + "_cycle.pause"), HasSubstr("done"));
    EXPECT_THAT(ask("call " + form + "_cycle.is_paused"), HasSubstr("\"result\": true"));
    EXPECT_THAT(follow(form + "_cycle.start"), HasSubstr("done"));
    EXPECT_THAT(ask("call " + form + "_cycle.is_paused"), HasSubstr("\"result\": false"));
    EXPECT_THAT(follow(form + "_cycle.stop"), HasSubstr("done"));
    EXPECT_THAT(ask("call " + form + "_cycle.is_in Safe"), HasSubstr("\"result\": true"));
}

TEST_P(Task, of_a_program_runs_and_reports_its_result) {
    EXPECT_THAT(follow(form + "_strokes.pause"), HasSubstr("rejected")) << "it does not run";
    EXPECT_THAT(follow(form + "_strokes.run 3"), AllOf(HasSubstr("done"), HasSubstr("3")));
    EXPECT_THAT(ask("get " + form + "_strokes.wanted"), HasSubstr("3"));
    EXPECT_THAT(ask("behaviours " + form + ".strokes"), HasSubstr(R"("return": 3)"));
}

INSTANTIATE_TEST_SUITE_P(compiled_and_loaded, Task, testing::Values("compiled", "loaded"),
                         [](const auto& form) { return std::string{form.param}; });

} // namespace
} // namespace tappet::press
