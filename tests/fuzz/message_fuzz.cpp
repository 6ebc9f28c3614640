// Any lines as messages of a client, and lines behind ! as packets of its machine: each message gets an
// answer, every answer is JSON, and neither bounds nor ids are exceeded.
#include "tests/fuzz/input.hpp"
#include "tests/toolchain/tools/gateway/rig.hpp"

#include <string_view>

namespace {

using namespace tappet::network;
using tappet::fuzz::demand;

/// Judges what is sent.
struct Judge : Outlet {
    bool offer(std::string frame) override {
        demand(frame.size() >= frame_head_bytes);
        return frames++ % 3 != 0;
    }
    bool has_room() const override { return true; }
    void send(std::string text) override {
        const auto object = nlohmann::json::parse(text, nullptr, false);
        demand(object.is_object() && object.contains("id"));
        ++texts;
    }
    void end(std::string_view reason) override { demand(reason.size() < 124); }
    std::size_t frames = 0;
    std::size_t texts = 0;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static Rig rig;
    static bool once = (rig.machine.write("shaft.angle", 12.5), true);
    demand(once);
    std::string_view rest{reinterpret_cast<const char*>(data), size};
    Judge judge;
    const auto peer = rig.join(judge);
    while (!rest.empty()) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        if (line.starts_with('!')) {
            if (rig.line.open) rig.line.receive(line.substr(1));
            continue;
        }
        const bool may_wait = line.contains("request");
        const std::size_t before = judge.texts;
        peer->receive(line, rig.now);
        demand(may_wait || judge.texts > before);
        rig.tick();
    }
    return 0;
}
