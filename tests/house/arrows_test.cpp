// One table says which folder may include which. Arrows point downwards only, and includes form no cycle.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>

namespace tappet::house {
namespace {

struct Row {
    std::string_view folder;
    /// Folders, or single headers, that this one may include, together with everything that those may
    /// include.
    std::vector<std::string_view> stands_on;
};

// A file belongs to the longest row that names a folder above it.
// clang-format off
const std::vector<Row> house{
    {"kernel/base",       {}},
    {"kernel/os",         {"kernel/base"}},
    {"kernel/exchange",   {"kernel/base"}},
    {"kernel/cam",        {"kernel/base"}},
    {"kernel/motion",     {"kernel/base"}},
    {"kernel/component",  {"kernel/os", "kernel/exchange"}},
    {"kernel/pieces",     {"kernel/component", "kernel/cam"}},
    {"kernel/activity",   {"kernel/component"}},
    {"kernel/program",    {"kernel/activity"}},
    {"kernel/statechart", {"kernel/program"}},
    {"kernel/script",     {"kernel/statechart"}},
    {"kernel/machine/table",    {"kernel/script"}},
    {"kernel/machine/check",    {"kernel/machine/table"}},
    {"kernel/machine/slots",    {"kernel/machine/table"}},
    {"kernel/machine/plan",     {"kernel/machine/check", "kernel/machine/slots"}},
    {"kernel/machine/map",      {"kernel/machine/plan"}},
    {"kernel/machine",          {"kernel/machine/map"}},
    {"kernel/machine/instance", {"kernel/machine"}},
    {"kernel/machine/worlds",   {"kernel/machine/instance"}},
    {"kernel/limits",     {"kernel/machine/instance"}},
    {"kernel/control",    {"kernel/machine/instance"}},
    {"kernel/services",   {"kernel/machine/worlds"}},
    {"kernel/system",     {"kernel/machine/check"}},

    {"drivers/map",       {"kernel/component"}},
    {"drivers/twin",      {"drivers/map"}},
    {"drivers/camera",    {"kernel/component", "drivers/twin"}},
    {"drivers/can",       {"kernel/component", "drivers/twin"}},
    {"drivers/gpio",      {"kernel/component", "drivers/twin"}},
    {"drivers/modbus",    {"kernel/component", "drivers/twin"}},
    {"drivers/udp",       {"kernel/component", "drivers/twin"}},
    {"drivers/canopen",   {"drivers/can", "kernel/pieces", "kernel/motion"}},
    {"drivers/instruments", {"kernel/component"}},
    {"drivers/system",    {"kernel/system", "drivers/can"}},
    {"drivers/hardware",  {"kernel/machine/instance", "drivers/camera", "drivers/can", "drivers/gpio", "drivers/modbus", "drivers/udp"}},
    {"drivers/plant",     {"kernel/services", "drivers/hardware"}},

    {"board/init",        {}},
    {"board/box",         {"board/init", "kernel/os"}},
    {"board",             {"board/init", "kernel/services", "kernel/limits", "kernel/control", "kernel/cam", "kernel/motion", "drivers/camera", "drivers/can", "drivers/gpio", "drivers/modbus", "drivers/canopen", "drivers/instruments"}},
    // A machine may include its claims for spin, its host's views, and the rules of its swarm; a plant may
    // contain another machine.
    {"apps",              {"board", "drivers/plant", "drivers/system", "kernel/pieces", "toolchain/tools/chart/model.hpp", "toolchain/machine/host.hpp", "toolchain/machine/host_hooks.hpp", "toolchain/machine/system_run.hpp", "toolchain/machine/bench/plant_program.hpp", "toolchain/command_line.hpp", "toolchain/version.hpp", "toolchain/svg.hpp", "toolchain/machine/swarm_rules.hpp"}},
    // A plant uses a machine's frames, lines and registers only.
    {"apps/carpet_loom/plant", {"kernel/base", "kernel/services/json.hpp", "apps/carpet_loom/wires.hpp", "apps/carpet_loom/maps.hpp", "apps/carpet_loom/network.hpp", "drivers/canopen"}},

    // A browser uses a machine's memory and socket only.
    {"toolchain/tools/browser", {"kernel/base", "kernel/machine/map/layout.hpp", "kernel/machine/map/black_box.hpp", "kernel/machine/map/view.hpp",
                           "kernel/machine/plan/scope_layout.hpp", "kernel/activity/cycle_tape.hpp", "kernel/services/reporting/layout.hpp",
                           "kernel/services/browsing/protocol.hpp", "toolchain/version.hpp"}},

    {"toolchain",         {"kernel/base"}},
    // A gateway relays to machines as a browser; users have a machine's roles.
    {"toolchain/tools/gateway", {"toolchain", "toolchain/tools/browser", "kernel/component/role.hpp"}},
    {"toolchain/machine", {"board", "drivers/plant", "kernel/system", "toolchain/tools/chart"}},
    {"toolchain/tools/chart", {"kernel/machine", "toolchain", "drivers/can"}},
    {"toolchain/tools/bench", {"kernel/base", "toolchain/version.hpp"}},
    {"toolchain/tools/image", {"toolchain", "toolchain/tools/bench", "board/box"}},
    {"toolchain/tables",  {"drivers/canopen"}},
    {"toolchain/tools/check", {"drivers/canopen"}},
    {"toolchain/tools/front", {"toolchain", "toolchain/tools/check", "toolchain/machine/host_options.hpp", "toolchain/tools/chart/options.hpp", "toolchain/tools/image/options.hpp"}},
    {"toolchain/tools/pages", {"drivers/plant", "drivers/system", "kernel/pieces", "drivers/instruments", "drivers/canopen", "toolchain/tools/browser", "kernel/control"}},
    {"apps/carpet_loom/demo", {"apps", "toolchain", "toolchain/tools/bench", "toolchain/tools/browser"}},
    {"tests",             {"apps", "toolchain/machine", "toolchain/tools/front", "apps/carpet_loom/demo", "apps/carpet_loom/plant", "toolchain/tools/browser", "toolchain/tools/pages", "toolchain/tools/check", "toolchain/tools/gateway", "toolchain/tools/image", "toolchain/tables"}},
};
// clang-format on

const Row* row_of(std::string_view path) {
    const Row* best = nullptr;
    for (const Row& row : house) {
        const bool above =
            path.starts_with(row.folder) && path.size() > row.folder.size() && path[row.folder.size()] == '/';
        if (above && (best == nullptr || row.folder.size() > best->folder.size())) best = &row;
    }
    return best;
}

/// The folders that a row may include: itself, its dependencies, and theirs in turn. The machine's program
/// may hold its plant.
std::set<std::string_view> reach(const Row& row) {
    std::set<std::string_view> found{row.folder};
    std::vector<std::string_view> open(row.stands_on);
    while (!open.empty()) {
        const std::string_view next = open.back();
        open.pop_back();
        if (!found.insert(next).second) continue;
        for (const Row& below : house)
            if (below.folder == next) open.insert(open.end(), below.stands_on.begin(), below.stands_on.end());
    }
    if (row.folder == "apps") found.insert("apps/carpet_loom/plant");
    return found;
}

bool is_ours(std::string_view include) {
    return std::ranges::any_of(house, [&](const Row& row) {
        return include.substr(0, include.find('/')) == row.folder.substr(0, row.folder.find('/'));
    });
}

Findings wrong_arrows(const Tree& files) {
    Findings found;
    for (const File& file : files) {
        if (!file.is_cpp()) continue;
        const Row* from = row_of(file.path);
        if (from == nullptr) {
            found.push_back({file.path, 1, "no row of the house holds this folder",
                             "add one to tests/house/arrows_test.cpp"});
            continue;
        }
        const auto allowed = reach(*from);
        for (const Include& include : includes(file)) {
            if (!include.quoted || !is_ours(include.name)) continue;
            const Row* to = row_of(include.name);
            if (allowed.contains(include.name) || (to != nullptr && allowed.contains(to->folder))) continue;
            found.push_back(
                {file.path, include.line,
                 std::string(from->folder) + " includes " + include.name + ", which it does not stand on",
                 "move what is shared to a folder that both stand on"});
        }
    }
    return found;
}

Findings empty_rooms(const Tree& files) {
    Findings found;
    for (const Row& row : house)
        if (std::ranges::none_of(files, [&](const File& file) { return file.is_under(row.folder); }))
            found.push_back({std::string(row.folder), 1, "has a row of the house and no file",
                             "remove the row; it comes with its first file"});
    return found;
}

Findings foreign_quotes(const Tree& files) {
    Findings found;
    for (const File& file : files)
        for (const Include& include : includes(file)) {
            if (include.quoted != is_ours(include.name) && !file.is_under("board/bench/gpio_sim"))
                found.push_back(
                    {file.path, include.line, "\"" + include.name + "\" is spelt against the house",
                     "our headers are in quotes and written from the root, all others in angle brackets"});
        }
    return found;
}

/// Follows the includes from each file in depth; a file met again while it is open closes a cycle.
class Circles {
public:
    explicit Circles(const Tree& files) {
        for (const File& file : files) by_path_[file.path] = &file;
        for (const File& file : files) visit(file);
    }
    [[nodiscard]] const Findings& found() const { return found_; }

private:
    void visit(const File& file) {
        if (done_.contains(file.path)) return;
        open_.insert(file.path);
        for (const Include& include : includes(file)) {
            const auto next = by_path_.find(include.name);
            if (next == by_path_.end()) continue;
            if (open_.contains(include.name))
                found_.push_back({file.path, include.line, "including " + include.name + " closes a circle",
                                  "move what both need into a third header"});
            else
                visit(*next->second);
        }
        open_.erase(file.path);
        done_.insert(file.path);
    }

    std::map<std::string, const File*> by_path_;
    std::set<std::string> open_;
    std::set<std::string> done_;
    Findings found_;
};

TEST(Arrows, point_downwards_only) { expect_none(wrong_arrows(tree())); }
TEST(Arrows, have_a_folder_at_each_row) { expect_none(empty_rooms(tree())); }
TEST(Arrows, form_no_cycle) { expect_none(Circles(tree()).found()); }
TEST(Arrows, are_spelt_from_the_root_in_quotes) { expect_none(foreign_quotes(tree())); }

TEST(ArrowsRule, refuses_a_lower_folder_that_includes_a_higher_one) {
    const auto found = wrong_arrows(
        {file("kernel/os/clock.hpp", "// A clock.\n#include \"kernel/machine/plan/plan.hpp\"\n")});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].line, 2u);
}

TEST(ArrowsRule, follows_the_table_over_several_steps) {
    EXPECT_TRUE(wrong_arrows({file("drivers/canopen/x.hpp", "#include \"kernel/base/time.hpp\"\n")}).empty());
    EXPECT_TRUE(wrong_arrows({file("kernel/services/x.hpp", "#include \"kernel/os/clock.hpp\"\n")}).empty());
}

TEST(ArrowsRule, refuses_drivers_that_include_each_other_and_the_machine) {
    EXPECT_EQ(wrong_arrows({file("drivers/can/x.hpp", "#include \"drivers/gpio/lines.hpp\"\n")}).size(), 1u);
    EXPECT_EQ(wrong_arrows({file("drivers/can/x.hpp", "#include \"kernel/machine/plan/plan.hpp\"\n")}).size(),
              1u);
}

TEST(ArrowsRule, refuses_includes_of_an_app_and_a_plant_that_knows_its_machine) {
    EXPECT_EQ(wrong_arrows({file("board/bench/x.cpp", "#include \"apps/carpet_loom/loom.hpp\"\n")}).size(),
              1u);
    EXPECT_EQ(wrong_arrows({file("apps/carpet_loom/plant/x.cpp", "#include \"apps/carpet_loom/loom.hpp\"\n")})
                  .size(),
              1u);
}

TEST(ArrowsRule, refuses_a_row_without_a_folder) {
    EXPECT_EQ(empty_rooms({file("kernel/os/x.hpp", "// A clock.\n")}).size(), house.size() - 1);
}

TEST(ArrowsRule, refuses_a_folder_without_a_row) {
    EXPECT_EQ(wrong_arrows({file("kernel/attic/x.hpp", "// Old.\n")}).size(), 1u);
}

TEST(ArrowsRule, does_not_take_a_comment_for_an_include) {
    EXPECT_TRUE(
        wrong_arrows({file("kernel/os/x.hpp", "// #include \"apps/carpet_loom/loom.hpp\"\n")}).empty());
}

TEST(ArrowsRule, finds_a_cycle_of_three) {
    const Tree three{file("a/a.hpp", "#include \"a/b.hpp\"\n"), file("a/b.hpp", "#include \"a/c.hpp\"\n"),
                     file("a/c.hpp", "#include \"a/a.hpp\"\n")};
    EXPECT_EQ(Circles(three).found().size(), 1u);
}

TEST(ArrowsRule, refuses_a_foreign_header_in_quotes) {
    EXPECT_EQ(foreign_quotes({file("kernel/os/x.hpp", "#include \"unistd.h\"\n")}).size(), 1u);
    EXPECT_EQ(foreign_quotes({file("kernel/os/x.hpp", "#include <kernel/base/time.hpp>\n")}).size(), 1u);
}

TEST(ArrowsTable, has_no_cycle) {
    for (const Row& row : house)
        for (const std::string_view below : reach(row))
            for (const Row& other : house) {
                if (other.folder != below || &other == &row) continue;
                EXPECT_FALSE(reach(other).contains(row.folder))
                    << row.folder << " and " << below << " stand on each other";
            }
}

} // namespace
} // namespace tappet::house
