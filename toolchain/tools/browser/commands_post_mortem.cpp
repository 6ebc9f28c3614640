// SPDX-License-Identifier: Apache-2.0
// Shows a machine that has ended, from its guardian's black box.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/value.hpp"

#include <array>
#include <ctime>
#include <ios>
#include <ostream>

namespace tappet::browser {

namespace {

std::string date_of(std::int64_t wall_ns) {
    const std::time_t seconds = wall_ns / 1'000'000'000;
    std::tm parts{};
    ::gmtime_r(&seconds, &parts);
    std::array<char, 40> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &parts);
    return text.data();
}

Result<void> tell(Work& work) {
    const MapReader& map = work.session.map();
    const map::black_box::Record& box = *work.session.black_box();
    const std::string_view build{box.build_id.data()}, done{box.done.data()};
    if (work.line.json) {
        const auto text = [&](std::string_view name, std::string_view value) {
            work.out << in_quotes(name) << ": " << in_quotes(value) << ", ";
        };
        work.out << "{";
        text("machine", box.machine.data());
        text("board", box.board.data());
        text("build_id", build);
        text("at", date_of(box.wall_ns));
        text("reason", box.reason.data());
        text("done", done);
        text("thread", box.thread_name.data());
        work.out << "\"number\": " << box.number << ", \"signal\": " << box.signal
                 << ", \"instruction\": " << box.instruction << ", \"returns\": [";
        for (std::size_t i = 0; i < box.returns.size() && box.returns[i] != 0; ++i)
            work.out << (i == 0 ? "" : ", ") << box.returns[i];
        work.out << "], \"address\": " << box.address << ", \"exit_code\": " << box.exit_code << "}\n";
        return {};
    }
    work.out << box.machine.data() << " on board " << box.board.data() << ", build "
             << (build.empty() ? "without an id" : build) << "\n"
             << "black box " << box.number << ", " << date_of(box.wall_ns) << ": " << box.reason.data()
             << "; exit code " << box.exit_code << "\n";
    if (!done.empty()) work.out << "told: " << done << "\n";
    if (box.signal != 0) {
        work.out << "source, then callers (some may have returned before): addr2line -Cfipe FIRMWARE"
                 << std::hex << " 0x" << box.instruction;
        for (const std::uint64_t address : box.returns)
            if (address != 0) work.out << " 0x" << address - 1; // of the call, not of what follows it
        work.out << std::dec << " (the firmware of this build, not stripped)\n";
    }
    for (std::uint32_t a = 0; a < map.activities().size(); ++a)
        work.out << "activity " << map.text(map.activities()[a].name)
                 << (work.session.observer().generation(a) % 2 == 0
                         ? ": slept\n"
                         : ": was in its cycle; what it writes may be half written\n");
    work.out << work.session.observer().forced() << " ports forced\n"
             << "more: post-mortem FILE list | get NAME... | tree | info NAME | forced | reactions | scope | "
                "behaviour [NAME]\n";
    return {};
}

} // namespace

Result<void> run_post_mortem(Work& work) {
    if (work.session.black_box() == nullptr)
        return wrong("this machine is running; start with tappet-browse post-mortem FILE");
    if (work.arguments().size() == 1) return tell(work);
    Line line = work.line;
    line.words.erase(line.words.begin(), line.words.begin() + 2);
    Work read{work, work.session, line};
    if (find_command(line.words.front()) == nullptr) return wrong(unknown_command(line.words.front()));
    return run_command(read);
}

} // namespace tappet::browser
