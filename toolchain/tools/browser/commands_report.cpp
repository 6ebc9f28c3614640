// The report: records the machine's values into a file, and prints such files as tables.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/csv.hpp"
#include "toolchain/tools/browser/record_file.hpp"
#include "toolchain/tools/browser/recording.hpp"
#include "toolchain/tools/browser/value.hpp"

#include <ctime>
#include <ostream>

namespace tappet::browser {

namespace {

using Steady = std::chrono::steady_clock;

/// A tape holds half a second: at this interval nothing is overwritten unread unless the box is too busy.
constexpr std::chrono::milliseconds between_looks{10};

std::int64_t now_of(clockid_t clock) {
    timespec now{};
    ::clock_gettime(clock, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::string rule_of(const RecordedChannel& channel) {
    if (channel.of.is_event != 0) return "each emission, in the cycle that saw it";
    if (channel.of.every > 1) return "every " + std::to_string(channel.of.every) + " steps";
    if (channel.of.every == 1) return "every step";
    if (channel.of.band == 0) return "on change";
    std::string band = std::to_string(channel.of.band);
    band.erase(band.find_last_not_of('0') + 1);
    return "on change by more than " + (band.ends_with('.') ? band.substr(0, band.size() - 1) : band);
}

std::string window_of(const RecordReader& reader, const recorded::Channel& channel) {
    if (channel.trigger == recorded::none) return {};
    return ", from " + duration_text(channel.before_ns) + " before " +
           reader.channels()[channel.trigger].name + " to " + duration_text(channel.after_ns) + " after it";
}

Result<void> list(Work& work, const RecordReader& reader) {
    const MapReader& map = work.session.map();
    for (const RecordedChannel& each : reader.channels()) {
        const map::Facet& facet = map.facets()[each.facet];
        const std::string_view unit = map.text(facet.unit);
        const std::string rule = rule_of(each) + window_of(reader, each.of);
        if (work.line.json)
            work.out << "{\"channel\": " << in_quotes(each.name)
                     << ", \"type\": " << in_quotes(type_name(map, facet.type))
                     << ", \"unit\": " << in_quotes(unit) << ", \"rule\": " << in_quotes(rule) << "}\n";
        else
            work.out << each.name << "  " << rule << (unit.empty() ? "" : "  ") << unit << "\n";
    }
    return {};
}

Result<void> start(Work& work, RecordReader reader) {
    const std::string& name = work.line.words[2];
    if (!name.ends_with(".mcap"))
        return wrong("'report start' writes a file that ends with .mcap, not '" + name +
                     "'; 'report convert' makes a .csv of it");
    auto file = work.files.create(name);
    if (!file) return std::unexpected(file.error());
    Recording recording{work.session.map(), reader.channels(),
                        now_of(CLOCK_REALTIME) - now_of(CLOCK_MONOTONIC)};
    if (!work.line.json)
        work.out << "records " << reader.channels().size() << " values into " << name
                 << (work.files.are_here() ? "; ^C or 'report stop " + name + "' ends it" : "; ^C ends it")
                 << std::endl;
    recording.add(reader.begin());
    const auto end = Steady::now() + work.line.length;
    const bool is_limited = work.line.length.count() > 0;
    bool has_ended = false;
    for (bool last = false; !last;) {
        // Checked before reading the tapes, so that everything recorded until the end is read.
        has_ended = work.session.link().ended();
        last =
            has_ended || work.stopped() || !(*file)->fault().empty() || (is_limited && Steady::now() >= end);
        // Samples that wait too long for the disk are overwritten in the machine, and counted as lost.
        if (!(*file)->is_behind()) recording.add(reader.follow());
        if (last) recording.end();
        (*file)->write(recording.take());
        if (!last) std::this_thread::sleep_for(between_looks);
    }
    if (const auto done = (*file)->finish(); !done) return done;
    if (work.line.json)
        work.out << "{\"file\": " << in_quotes(name) << ", \"samples\": " << recording.samples()
                 << ", \"lost\": " << recording.lost() << "}\n";
    else
        work.out << "written to " << name << ": " << recording.samples() << " samples"
                 << (has_ended ? "; the machine has ended" : "") << "\n";
    if (recording.lost() > 0 && !work.line.json)
        work.out << recording.lost() << " samples were overwritten before they were read, see the channel \""
                 << lost_topic << "\"; is the box busy?\n";
    return {};
}

Result<void> convert(const Line& line, const Means& means) {
    const std::string& from = line.words[2];
    const std::string& to = line.words[3];
    if (!to.ends_with(".csv"))
        return wrong("'report convert' makes a file that ends with .csv, not '" + to + "'");
    if (means.files.exists(to)) return wrong("'" + to + "' exists already; name another file, or remove it");
    const auto bytes = means.files.read(from);
    if (!bytes) return std::unexpected(bytes.error());
    const auto contents = mcap::read(*bytes);
    if (!contents) return wrong("'" + from + "' " + contents.error());
    if (const auto written = means.files.write(to, as_csv(*contents)); !written) return written;
    if (!contents->damage.empty())
        return wrong("'" + from + "' is damaged, " + contents->damage + "; the " +
                     std::to_string(contents->messages.size()) + " undamaged messages are in '" + to + "'");
    if (line.json)
        means.out << "{\"messages\": " << contents->messages.size()
                  << ", \"whole\": " << (contents->has_end ? "true" : "false") << "}\n";
    else
        means.out << "written to " << to << ": " << contents->messages.size() << " messages of "
                  << contents->channels.size() << " channels"
                  << (contents->has_end ? "" : "; the recording was cut off, and is good up to that point")
                  << "\n";
    return {};
}

} // namespace

bool is_about_files(const Line& line) {
    return line.words.size() > 1 && line.words[0] == "report" &&
           (line.words[1] == "convert" || line.words[1] == "stop");
}

Result<void> run_report_of_files(const Line& line, const Means& means) {
    const std::size_t wanted = line.words[1] == "convert" ? 4 : 3;
    if (line.words.size() != wanted)
        return wrong("'report " + line.words[1] + "' takes " +
                     (wanted == 4 ? "two files: FILE.mcap FILE.csv" : "the file of 'report start'"));
    if (wanted == 4) return convert(line, means);
    if (!means.files.are_here())
        return wrong(
            "'report stop' ends a recording of a program on this host; end the program that shows it");
    return stop_recording(line.words[2]);
}

Result<void> run_report(Work& work) {
    if (is_about_files(work.line)) return run_report_of_files(work.line, work);
    auto reader = RecordReader::open(work.session.map());
    if (!reader) return wrong(reader.error());
    const std::size_t count = work.line.words.size();
    if (count == 1 || (count == 2 && work.line.words[1] == "list")) return list(work, *reader);
    if (count == 3 && work.line.words[1] == "start") return start(work, std::move(*reader));
    return wrong("'report' has the wrong arguments; usage: " + std::string{find_command("report")->usage});
}

} // namespace tappet::browser
