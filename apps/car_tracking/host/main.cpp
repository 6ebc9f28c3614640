// The car tracker on the host: machine and room in one process, under virtual time.
#include "apps/car_tracking/host/options.hpp"
#include "apps/car_tracking/host/picture.hpp"
#include "kernel/os/terminal.hpp"

#include <array>

namespace {

using namespace tappet;

int fail(const Sentence& why) {
    static_cast<void>(os::write_all(2, Sentence{"car_tracking: ", why, "\n"}.view()));
    return 2;
}

void report(const car_tracking::VirtualRun& run) {
    std::size_t located = 0;
    double worst = 0.0;
    for (const auto& look : run.looks()) {
        if (!look.located) continue;
        ++located;
        worst = std::max(worst, look.error_m());
    }
    char digest[17] = {};
    for (std::size_t i = 0; i < 16; ++i) digest[i] = "0123456789abcdef"[run.digest() >> (60 - 4 * i) & 0xF];
    os::print(Sentence{"car_tracking: ", run.looks().size(), " images, the car in ", located,
                       " of them, located to ", static_cast<std::int64_t>(worst * 1000.0 + 0.5),
                       " mm at worst; digest ", std::string_view{digest}, "\n"}
                  .view());
}

} // namespace

int main(int count, char** words) {
    const auto options = car_tracking::parse_options(count, words);
    if (!options) return fail(options.error());
    if (options->help) {
        os::print(car_tracking::usage);
        return 0;
    }
    static car_tracking::VirtualRun run{options->seed};
    if (const auto started = run.start(); !started) return fail(started.error());
    if (!run.run_for(std::chrono::seconds{options->seconds})) return fail(run.instance().describe_stop());
    run.stop();
    report(run);
    if (options->picture.empty()) return 0;
    const std::string path{options->picture};
    const std::string picture = car_tracking::picture_of(run.moments(), run.looks());
    if (!os::replace_file(path.c_str(), picture))
        return fail(Sentence{"the picture cannot be written to \"", options->picture,
                             "\"; name a file in a folder that exists"});
    return 0;
}
