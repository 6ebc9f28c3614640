// Writes candump logs of simulated buses, and replays them.
#include "drivers/plant/can_log.hpp"

#include <algorithm>
#include <filesystem>

namespace tappet {

namespace {

/// candump counts in microseconds: times this close may be the same moment.
constexpr Duration tick = 1us;
/// Time servers set a clock back by more than this, and otherwise slow it down. Lines in disorder, as those
/// of two sockets, are closer.
constexpr Duration least_set_back = 100ms;

constexpr std::uint32_t key_of(const can::Frame& frame) {
    return frame.id | (frame.extended ? 0x8000'0000u : 0u);
}
bool has(std::span<const can::Identifier> list, const can::Frame& frame) {
    return std::ranges::find(list, can::Identifier{frame.id, frame.extended}) != list.end();
}
/// Returns seconds with microseconds, as candump writes them.
Sentence seconds(Duration since) {
    const std::int64_t us = since / tick;
    const Sentence fraction{1'000'000 + us % 1'000'000};
    return Sentence{us / 1'000'000, ".", fraction.view().substr(1)};
}
bool say_the_same(const can::Frame& a, const can::Frame& b) {
    return a.length == b.length && can::format_of(a) == can::format_of(b) &&
           std::equal(a.data.begin(), a.data.begin() + a.length, b.data.begin());
}

} // namespace

Sentence CanRecorder::open(std::string_view bus, const std::string& folder) {
    bus_ = bus;
    std::string name = bus_;
    std::ranges::replace_if(name, [](char c) { return c == '/' || c <= ' '; }, '_');
    path_ = (std::filesystem::path{folder} / (name + ".log")).string();
    std::error_code fault;
    std::filesystem::create_directories(folder, fault);
    if (std::filesystem::is_regular_file(path_, fault)) // a device takes it
        return Sentence{"\"", path_, "\" exists already; name another folder, or remove it"};
    file_.open(path_, std::ios::trunc);
    return file_ ? Sentence{}
                 : Sentence{"\"", path_, "\" cannot be written; name a folder in which you may write"};
}

void CanRecorder::record(const can::Frame& frame) {
    can::Frame logged = frame;
    logged.stamp = Time{frame.stamp - begun_};
    if (frames_++ == 0) first_ = logged.stamp;
    file_ << can::candump::write(logged, bus_).view() << '\n';
}

Sentence CanRecorder::close(bool& good) {
    file_.close();
    good = !file_.fail();
    if (!good) return Sentence{"\"", path_, "\" could not be written to its end; is the disk full?"};
    Sentence told{"CAN bus \"", bus_, "\": ", frames_, " frames recorded in ", path_};
    if (frames_ == 0) return told;
    told.add("; they are replayed by --replay-can ").add(bus_).add("=").add(path_);
    if (first_ != Time{}) told.add("@").add(seconds(first_.time_since_epoch()));
    return told;
}

Sentence CanReplay::open(std::string_view bus, const std::string& path, Duration begins_at,
                         std::span<const can::Identifier> received, std::span<const can::Identifier> sent) {
    bus_ = bus;
    path_ = path;
    begins_at_ = begins_at;
    received_ = received;
    sent_ = sent;
    file_.open(path_);
    if (!file_) return Sentence{"\"", path_, "\" cannot be read; name a log of candump -L or -l"};
    while (read_line()) {
        const Kind kind = kind_of(read_);
        count(kind);
        if (kind == Kind::own) own_.try_emplace(key_of(read_.frame));
    }
    if (!fault_.empty()) return fault_;
    if (interface_.empty())
        return Sentence{path_, ": there is no frame in it; name a log of candump -L or -l"};
    if (counts_.played == 0)
        return Sentence{path_, ": none of its frames has an identifier that the machine receives on \"", bus_,
                        "\"; is it the log of that bus?"};
    file_.clear();
    file_.seekg(0);
    line_ = 0;
    interface_.clear();
    counts_.set_back = 0;
    is_over_ = !read_line();
    return fault_;
}

bool CanReplay::refuse(std::size_t column, std::string_view what, std::string_view more,
                       std::string_view end) {
    fault_ = Sentence{path_, ":", line_, ":", column, ": ", what, more, end};
    return false;
}

bool CanReplay::read_text() {
    do {
        if (!std::getline(file_, text_)) return false;
        ++line_;
        if (text_.ends_with('\r')) text_.pop_back();
        // A file system fills a file with zeros when power fails.
        while (file_.eof() && text_.ends_with('\0')) text_.pop_back(), counts_.is_cut = true;
    } while (text_.empty());
    return true;
}

bool CanReplay::read_line() {
    if (!read_text()) return file_.bad() ? refuse(1, "the file cannot be read") : false;
    const auto read = can::candump::read(text_);
    if (!read) {
        refuse(read.error().column, read.error().what);
        if (read.error().is_cut && !read_text()) counts_.is_cut = true, fault_ = {};
        return false;
    }
    if (file_.eof()) { // without its end, a line may lack bytes of its frame
        counts_.is_cut = true;
        return false;
    }
    read_ = *read;
    if (interface_.empty()) {
        interface_ = read_.interface;
        since_first_ = {};
        last_ = read_.frame.stamp;
    }
    if (read_.interface != interface_)
        return refuse(
            static_cast<std::size_t>(read_.interface.data() - text_.data()) + 1,
            "here is a frame of another interface; a bus is replayed from a log of its own: grep ' ",
            interface_, " '");
    return add_time();
}

bool CanReplay::add_time() {
    constexpr Duration longest{9'000'000'000s};
    const Duration step = read_.frame.stamp - last_;
    last_ = read_.frame.stamp;
    if (step >= Duration{}) {
        since_first_ += step;
        return since_first_ <= longest || refuse(2, "the log lasts more than 9000000000 seconds; divide it");
    }
    if (-step < least_set_back)
        return refuse(
            2, "this time is before that of the line above; put them in order: LC_ALL=C sort -s -k1.2n");
    if (counts_.set_back++ == 0) counts_.set_back_line = line_, counts_.set_back_by = -step;
    return true;
}

CanReplay::Kind CanReplay::kind_of(const can::candump::Logged& logged) const {
    if (logged.is_error) return Kind::error;
    if (logged.frame.remote) return Kind::remote;
    if (has(sent_, logged.frame)) return Kind::own;
    return has(received_, logged.frame) ? Kind::played : Kind::unknown;
}

void CanReplay::count(Kind kind) {
    counts_.played += kind == Kind::played ? 1u : 0u;
    counts_.unknown += kind == Kind::unknown ? 1u : 0u;
    counts_.remote += kind == Kind::remote ? 1u : 0u;
    counts_.errors += kind == Kind::error ? 1u : 0u;
}

void CanReplay::meet(const can::Frame& frame, bool is_logged) {
    const auto found = own_.find(key_of(frame));
    if (found == own_.end()) return; // the log has no frame with this identifier
    Waiting& waiting = found->second;
    if (waiting.frames.empty() || waiting.are_logged == is_logged) {
        waiting.are_logged = is_logged;
        waiting.frames.push_back(frame);
        return;
    }
    if (say_the_same(waiting.frames.front(), frame)) {
        ++counts_.equal;
    } else {
        ++counts_.different;
        const Time sent_at = is_logged ? waiting.frames.front().stamp : frame.stamp;
        counts_.first_different = std::min(counts_.first_different, sent_at);
    }
    waiting.frames.pop_front();
}

void CanReplay::heard(const can::Frame& frame) {
    if (!frame.remote && has(sent_, frame)) meet(frame, false);
}

bool CanReplay::waits_for_machine(Time now) const {
    if (now >= asked_until_) return false;
    const Waiting& waiting = own_.at(asked_);
    return waiting.are_logged && !waiting.frames.empty();
}

void CanReplay::play(can::TwinBus& bus, Time now) {
    if (begun_ == never) begun_ = now;
    while (!is_over_ && !waits_for_machine(now)) {
        next_ = begun_ + begins_at_ + since_first_;
        if (next_ > now) return;
        switch (kind_of(read_)) {
        case Kind::played: bus.put(read_.frame, now); break;
        case Kind::own:
            meet(read_.frame, true);
            asked_ = key_of(read_.frame);
            asked_until_ = next_ + tick;
            break;
        case Kind::unknown:
        case Kind::remote:
        case Kind::error: break;
        }
        is_over_ = !read_line();
    }
    next_ = is_over_ ? never : asked_until_;
}

CanReplay::Counts CanReplay::counts() const {
    Counts all = counts_;
    for (const auto& [key, waiting] : own_)
        (waiting.are_logged ? all.only_in_log : all.only_sent) += waiting.frames.size();
    return all;
}

Sentence CanReplay::report() const {
    const Counts c = counts();
    Sentence told{"CAN bus \"", bus_, "\": "};
    if (is_over_)
        told.add(c.played).add(" frames of ").add(path_).add(" replayed");
    else
        told.add(path_).add(" replayed up to its line ").add(line_);
    if (c.is_cut) told.add("; its last line is cut off, and left out");
    if (c.set_back != 0)
        told.add("; its clock was set back ")
            .add(c.set_back)
            .add(c.set_back == 1 ? " time (line " : " times (first in line ")
            .add(c.set_back_line)
            .add(", by ")
            .add(seconds(c.set_back_by))
            .add(" s), each a new stretch (in disorder? LC_ALL=C sort -s -k1.2n)");
    told.add("; left out ")
        .add(c.unknown)
        .add(" of other identifiers, ")
        .add(c.remote)
        .add(" remote and ")
        .add(c.errors)
        .add(" error frames; of the frames that the machine sent, ")
        .add(c.equal)
        .add(" are as in the log, ")
        .add(c.different)
        .add(" are not");
    if (c.different != 0)
        told.add(" (the first ").add(seconds(c.first_different - begun_)).add(" s after the beginning)");
    if (c.only_in_log + c.only_sent != 0)
        told.add(", ")
            .add(c.only_in_log)
            .add(" are only in the log and ")
            .add(c.only_sent)
            .add(" are not in it");
    return told;
}

} // namespace tappet
