// The loom's verification describes its C++ programs correctly: each of them runs on a component and emits
// the events of its row, in their order; a program without a row emits none.
#include "apps/carpet_loom/loom_model.hpp"
#include "toolchain/tools/chart/names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <string>
#include <vector>

namespace tappet::chart {
namespace {

/// A loom that records its emitted events.
class ListeningLoom {
public:
    ListeningLoom() {
        for (const Facet& facet : component_type<carpet::Loom>.facets) {
            if (facet.kind != FacetKind::event) continue;
            Ear& ear = ears_.emplace_back(Ear{this, "loom." + std::string{facet.name}, {}});
            void* const event = facet.at(&loom_, facet.index);
            facet.event->give_storage(event, &ear.room);
            static constexpr void (*hear)(void*) noexcept TAPPET_REALTIME = &ListeningLoom::note;
            facet.event->subscribe(event, &hear, &ear).store(1);
        }
    }
    std::vector<std::string> emitted_by(StateProgram program) {
        heard_.clear();
        program(&loom_);
        return heard_;
    }
    [[nodiscard]] std::size_t events() const { return ears_.size(); }

private:
    struct Ear {
        ListeningLoom* owner;
        std::string name;
        Subscriber<> room;
    };
    static void note(void* ear) noexcept TAPPET_REALTIME {
        const Ear& self = *static_cast<Ear*>(ear);
        TAPPET_ESCAPE("a test's own list", self.owner->heard_.push_back(self.name));
    }

    carpet::Loom loom_;
    std::deque<Ear> ears_;
    std::vector<std::string> heard_;
};

std::vector<std::string> said_of(StateProgram program) {
    std::vector<std::string> events;
    for (const ModelRow& row : carpet::model)
        if (row.kind == ModelKind::program && row.program == program)
            for (const std::string_view event : row.emits) events.emplace_back(event);
    return events;
}

TEST(LoomModel, emits_the_same_events_as_the_programs_of_the_loom) {
    ListeningLoom loom;
    ASSERT_GE(loom.events(), 8u);
    std::vector<StateProgram> programs;
    for (const StateRow& row : carpet::loom_cycle.states)
        for (const StateProgram each : {row.entry.call, row.exit.call, row.run.call})
            if (each != nullptr) programs.push_back(each);
    for (const TransitionRow& row : carpet::loom_cycle.transitions)
        if (row.then.call != nullptr) programs.push_back(row.then.call);
    std::size_t emissions = 0;
    for (const StateProgram program : programs) {
        const std::vector<std::string> emitted = loom.emitted_by(program);
        EXPECT_EQ(emitted, said_of(program)) << function_name(program);
        emissions += emitted.size();
    }
    EXPECT_GT(emissions, 10u) << "a loom that nobody hears shows nothing";
}

} // namespace
} // namespace tappet::chart
