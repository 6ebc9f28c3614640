// SPDX-License-Identifier: Apache-2.0
// tappet-image: writes what is flashed onto a box, from the firmware that shall run there.
#include "toolchain/command_line.hpp"
#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/tools/image/image.hpp"

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

namespace tappet::image {
namespace {

constexpr std::array options{
    Option{"--firmware", "FILE", "of one machine on one board, stripped"},
    Option{"--to", "DIR", "where disk.img, tappet.efi and their parts go"},
    Option{"--plant", "FILE",
           "of a test board: runs in the image, at the other end of the wires; its end is the box's"},
    Option{"--plant-options", "TEXT", "options of the plant, in one word"},
    Option{"--init", "FILE", "PID 1 (default: box-init beside this program)"},
    Option{.name = "--version",
           .value = "N",
           .help = "of the image (default 1)",
           .is_number = true,
           .least = 1,
           .most = 4'000'000'000},
    Option{.name = "--watchdog",
           .value = "SECONDS",
           .help = "armed by the loader before the kernel (default 30); 0: the box has none",
           .is_number = true,
           .least = 0,
           .most = 255}};

constexpr double goal_mb = 12.0;

int main(int count, char** words) {
    const std::vector<std::string_view> all(words + 1, words + count);
    if (all.empty() || all[0] == "--help") {
        std::printf("tappet-image --firmware FILE --to DIR: a disk image for a box\n%s",
                    usage_of(options).c_str());
        return all.empty() ? 2 : 0;
    }
    const auto line = read_command_line(options, all, Others::refused);
    const auto fail = [](const std::string& why) {
        std::fprintf(stderr, "tappet-image: %s\n", why.c_str());
        return 2;
    };
    if (!line) return fail(line.error());
    if (!line->has("--firmware") || !line->has("--to"))
        return fail("say --firmware FILE and --to DIR; see --help");
    Request request;
    request.firmware = line->text("--firmware");
    request.folder = line->text("--to");
    request.plant = line->text("--plant");
    request.plant_words = line->text("--plant-options");
    const auto own = std::filesystem::canonical("/proc/self/exe").parent_path() / "box-init";
    request.init = line->text("--init", own.native());
    request.kernel = bench::cache_folder() / "kernel/box";
    request.version = static_cast<std::uint32_t>(line->number("--version", 1));
    request.watchdog_s = static_cast<std::uint16_t>(line->number("--watchdog", 30));
    try {
        const Written written = write_image(request);
        const double slot_mb = static_cast<double>(written.slot_bytes) * 1e-6;
        std::printf(
            "%s\n  a slot takes %.1f MB (goal %.0f: %s): kernel %.1f MB, root %.1f MB with %zu modules\n",
            written.disk.c_str(), slot_mb, goal_mb, slot_mb <= goal_mb ? "held" : "MISSED",
            static_cast<double>(written.kernel_bytes) * 1e-6, static_cast<double>(written.root_bytes) * 1e-6,
            written.modules);
        std::printf("  command line: %s\n", written.command_line.c_str());
        return 0;
    } catch (const std::exception& fault) {
        return fail(fault.what());
    }
}

} // namespace
} // namespace tappet::image

int main(int count, char** words) { return tappet::image::main(count, words); }
