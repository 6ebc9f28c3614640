// The watchdog has one gate: one file accesses the device, few files may declare the outputs safe, and one
// kills all processes.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace tappet::house {
namespace {

struct Gate {
    std::string_view words;
    std::vector<std::string_view> files; ///< files that may use them
    std::string_view cure;
};

constexpr std::string_view ask_the_class = "use os::Watchdog of kernel/os/watchdog.hpp, which asks the latch";

const std::array gates{
    Gate{"<linux/watchdog.h>", {"kernel/os/watchdog.cpp"}, ask_the_class},
    Gate{"WDIOC_", {"kernel/os/watchdog.cpp"}, ask_the_class},
    Gate{"\"/dev/watchdog", {}, ask_the_class}, // except in the boards' headers
    Gate{"guardian_says_safe(",
         {"kernel/os/output_latch.hpp", "toolchain/machine/guardian.cpp", "toolchain/machine/safe_ending.cpp",
          "board/box/custody.cpp"},
         "only what a guardian did, or said, makes outputs safe"},
    Gate{"kill(-1", {"board/box/init.cpp"}, "end the box by Custody, which asks the guardian first"},
};

bool may_say(const Gate& gate, const File& file) {
    return file.is_under("tests") || std::ranges::find(gate.files, file.path) != gate.files.end() ||
           (file.is_under("board") && file.name() == "board.hpp");
}

Findings ways_around(const Tree& files) {
    Findings found;
    for (const File& file : files) {
        if (!file.is_cpp()) continue;
        for (std::size_t i = 0; i < file.lines.size(); ++i) {
            const std::string said = file.lines[i].substr(0, file.lines[i].find("//"));
            for (const Gate& gate : gates)
                if (said.contains(gate.words) && !may_say(gate, file))
                    found.push_back(
                        {file.path, i + 1, "says " + std::string{gate.words}, std::string{gate.cure}});
        }
    }
    return found;
}

TEST(Watchdog, has_no_way_around_its_latch) { expect_none(ways_around(tree())); }

TEST(WatchdogRule, finds_every_way_around) {
    for (const auto* line :
         {"#include <linux/watchdog.h>\n", "ioctl(f, WDIOC_KEEPALIVE, nullptr);\n",
          "open(\"/dev/watchdog0\", O_WRONLY);\n", "latch.guardian_says_safe();\n", "::kill(-1, SIGKILL);\n"})
        EXPECT_EQ(ways_around({file("board/box/a.cpp", line)}).size(), 1u) << line;
    EXPECT_TRUE(ways_around({file("board/box/a.cpp", "int a; // not kill(-1, SIGKILL)\n")}).empty());
    EXPECT_TRUE(ways_around({file("board/ipc/board.hpp", ".watchdog = \"/dev/watchdog\",\n")}).empty());
}

} // namespace
} // namespace tappet::house
