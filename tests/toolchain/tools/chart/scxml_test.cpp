// State machines as SCXML (W3C, 2015; thesis 5.2.4: a portable specification): the file is read back by an
// XML parser, and every reference in it leads somewhere.
#include "tests/toolchain/tools/chart/sample.hpp"
#include "toolchain/tools/chart/scxml.hpp"

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

namespace tappet::chart {
namespace {

struct Read {
    pugi::xml_document document;
    pugi::xml_parse_result result;
    explicit Read(const std::string& text) : result{document.load_buffer(text.data(), text.size())} {}

    void visit(const std::function<void(pugi::xml_node)>& each) const {
        const std::function<void(pugi::xml_node)> walk = [&](pugi::xml_node node) {
            each(node);
            for (pugi::xml_node child = node.first_child(); child; child = child.next_sibling()) walk(child);
        };
        walk(document.document_element());
    }
    [[nodiscard]] pugi::xml_node by_id(std::string_view id) const {
        pugi::xml_node found;
        visit([&](pugi::xml_node node) {
            if (id == node.attribute("id").value()) found = node;
        });
        return found;
    }
};

TEST(Scxml, is_well_formed_and_declares_every_target_once) {
    const Read read{to_scxml(press())};
    ASSERT_TRUE(read.result) << read.result.description();
    EXPECT_STREQ(read.document.document_element().name(), "scxml");
    EXPECT_STREQ(read.document.document_element().attribute("xmlns").value(),
                 "http://www.w3.org/2005/07/scxml");
    std::set<std::string> ids;
    read.visit([&](pugi::xml_node node) {
        if (node.attribute("id") && std::string_view{node.name()} != "send") {
            EXPECT_TRUE(ids.insert(node.attribute("id").value()).second) << node.attribute("id").value();
        }
    });
    std::size_t references = 0;
    read.visit([&](pugi::xml_node node) {
        for (const char* const name : {"target", "initial"}) {
            std::istringstream words{node.attribute(name).value()};
            for (std::string word; words >> word; ++references) EXPECT_TRUE(ids.contains(word)) << word;
        }
    });
    EXPECT_GT(references, press_transitions.size());
}

TEST(Scxml, has_regions_as_parallel_states) {
    const Read read{to_scxml(press())};
    EXPECT_STREQ(read.by_id("working").name(), "parallel");
    EXPECT_STREQ(read.by_id("working.ram").attribute("initial").value(), "up");
    EXPECT_STREQ(read.by_id("hot").parent().attribute("id").value(), "working.heat");
}

TEST(Scxml, sends_itself_a_time_out_and_cancels_it) {
    const Read read{to_scxml(press())};
    const pugi::xml_node down = read.by_id("down");
    EXPECT_STREQ(down.child("onentry").child("send").attribute("delay").value(), "20ms");
    EXPECT_STREQ(down.child("onexit").child("cancel").attribute("sendid").value(),
                 down.child("onentry").child("send").attribute("id").value());
    EXPECT_STREQ(down.child("transition").attribute("event").value(),
                 down.child("onentry").child("send").attribute("event").value());
}

TEST(Scxml, expresses_an_else_branch_as_the_next_transition_of_the_event) {
    const Read read{to_scxml(press())};
    const pugi::xml_node first = read.by_id("idle").child("transition");
    EXPECT_STREQ(first.attribute("cond").value(), "closed");
    EXPECT_STREQ(first.attribute("target").value(), "working");
    EXPECT_STREQ(first.next_sibling("transition").attribute("event").value(), "panel.start");
    EXPECT_STREQ(first.next_sibling("transition").attribute("target").value(), "held");
}

TEST(Scxml, has_history_internal_transitions_and_the_requests_of_every_machine) {
    const Read read{to_scxml(press())};
    EXPECT_STREQ(read.by_id("working.deep_history").attribute("type").value(), "deep");
    EXPECT_STREQ(read.by_id("working.deep_history").child("transition").attribute("target").value(),
                 "up cold");
    bool has_internal = false;
    for (const pugi::xml_node each : read.by_id("held").children("transition"))
        has_internal = has_internal || (!each.attribute("target") &&
                                        std::string_view{each.attribute("event").value()} == "panel.mark");
    EXPECT_TRUE(has_internal);
    EXPECT_STREQ(read.by_id("press").child("transition").attribute("event").value(), "request.final");
    EXPECT_STREQ(read.by_id("safe").child("transition").attribute("event").value(), "request.initial");
}

} // namespace
} // namespace tappet::chart
