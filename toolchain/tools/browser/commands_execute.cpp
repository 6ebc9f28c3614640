// A line of the script language: the machine compiles and executes it; the browser awaits and prints its end.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/value.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>

namespace tappet::browser {

namespace {

using nlohmann::ordered_json;

void tell(Work& work, const ordered_json& end) {
    if (end.contains("value"))
        work.out << end["value"].dump() << "\n";
    else if (end.contains("variables"))
        for (const auto& [name, value] : end["variables"].items())
            work.out << name << " = " << value.dump() << "\n";
    else
        work.out << "done\n";
}

Result<void> break_off(Work& work) {
    const auto reply = work.session.link().request("break_off");
    if (!reply) return std::unexpected(reply.error());
    work.out << (work.line.json ? R"({"ok": true})" : "broken off") << "\n";
    return {};
}

/// Returns its last packet. It also comes after the user gave up: then the machine was asked to break off.
Result<ordered_json> await_end(Work& work, std::uint32_t number) {
    Link& link = work.session.link();
    using Steady = std::chrono::steady_clock;
    Steady::time_point given_up = Steady::time_point::max();
    for (;;) {
        if (work.stopped() && given_up == Steady::time_point::max()) {
            static_cast<void>(link.request("break_off")); // it may have ended by itself
            given_up = Steady::now() + link.patience;
        }
        if (Steady::now() > given_up)
            return failure(Fault::too_late, "the machine does not tell how the line ended");
        auto packet = link.next(std::chrono::milliseconds{100});
        if (!packet) return std::unexpected(packet.error());
        if (*packet && (*packet)->value("id", std::uint32_t{0}) == number && (*packet)->value("final", false))
            return std::move(**packet);
    }
}

} // namespace

Result<void> run_execute(Work& work) {
    if (work.line.stop != work.arguments().empty())
        return wrong("execute takes a line or --stop; usage: " + std::string{find_command("execute")->usage});
    if (work.line.stop) return break_off(work);
    std::string line;
    for (const std::string& word : work.arguments()) line += (line.empty() ? "" : " ") + word;
    if (std::ranges::any_of(line, [](char each) { return static_cast<unsigned char>(each) < ' '; }))
        return wrong(
            "a line has no breaks and tabs; write blanks, or load a file with behaviour load FILE SLOT");
    std::uint32_t number = 0;
    const auto begun = work.session.link().request("execute " + quoted_word(line), number);
    if (!begun) return std::unexpected(begun.error());
    auto end = await_end(work, number);
    if (!end) return std::unexpected(end.error());
    if (work.line.json)
        work.out << packet_text(work, *end) << "\n";
    else if (end->value("line", std::string{}) == "done")
        tell(work, *end);
    if (end->value("line", std::string{}) == "done") return {};
    return failure(Fault::failed, end->value("error", std::string{"it failed"}));
}

} // namespace tappet::browser
