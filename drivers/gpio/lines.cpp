// libgpiod's calls in order. Its reads, gets and sets use the caller's memory and do not allocate.
#include "drivers/gpio/lines.hpp"

#include "drivers/gpio/chip.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <gpiod.h>
#include <string>

namespace tappet::gpio {
namespace {

template <class T, void (*Free)(T*)> struct Freed {
    void operator()(T* object) const noexcept { Free(object); }
};
template <class T, void (*Free)(T*)> using Owned = std::unique_ptr<T, Freed<T, Free>>;

using OwnedSettings = Owned<gpiod_line_settings, gpiod_line_settings_free>;
using OwnedLineConfig = Owned<gpiod_line_config, gpiod_line_config_free>;
using OwnedRequestConfig = Owned<gpiod_request_config, gpiod_request_config_free>;

gpiod_line_bias to_gpiod(Bias bias) {
    switch (bias) {
    case Bias::disabled: return GPIOD_LINE_BIAS_DISABLED;
    case Bias::pull_up: return GPIOD_LINE_BIAS_PULL_UP;
    case Bias::pull_down: return GPIOD_LINE_BIAS_PULL_DOWN;
    case Bias::as_is: break;
    }
    return GPIOD_LINE_BIAS_AS_IS;
}

/// Adds a line to the request; returns false with errno when libgpiod refuses.
bool add_line(gpiod_line_config* config, const Line& line) {
    const OwnedSettings settings{gpiod_line_settings_new()};
    if (!settings) return false;
    gpiod_line_settings* s = settings.get();
    gpiod_line_settings_set_active_low(s, line.active_low);
    bool ok = gpiod_line_settings_set_bias(s, to_gpiod(line.bias)) == 0;
    if (line.role == Role::output) {
        ok = ok && gpiod_line_settings_set_direction(s, GPIOD_LINE_DIRECTION_OUTPUT) == 0;
        ok = ok && gpiod_line_settings_set_output_value(s, line.safe_value ? GPIOD_LINE_VALUE_ACTIVE
                                                                           : GPIOD_LINE_VALUE_INACTIVE) == 0;
    } else {
        ok = ok && gpiod_line_settings_set_direction(s, GPIOD_LINE_DIRECTION_INPUT) == 0;
        ok = ok && gpiod_line_settings_set_edge_detection(s, GPIOD_LINE_EDGE_BOTH) == 0;
        ok = ok && gpiod_line_settings_set_event_clock(s, GPIOD_LINE_CLOCK_MONOTONIC) == 0;
        gpiod_line_settings_set_debounce_period_us(s,
                                                   static_cast<unsigned long>(line.debounce.count() / 1000));
    }
    return ok && gpiod_line_config_add_line_settings(config, &line.offset, 1, s) == 0;
}

} // namespace

void Lines::Release::operator()(gpiod_line_request* request) const noexcept {
    gpiod_line_request_release(request);
}
void Lines::Release::operator()(gpiod_edge_event_buffer* buffer) const noexcept {
    gpiod_edge_event_buffer_free(buffer);
}

std::expected<void, Sentence> Lines::open(const Settings& settings) {
    close();
    const auto planned = plan(settings);
    if (!planned) return std::unexpected{planned.error()};
    const auto chip = open_chip(settings.chip);
    if (!chip) return std::unexpected{chip.error()};
    if (auto free = check_lines(chip->get(), settings); !free) return free;

    const OwnedLineConfig config{gpiod_line_config_new()};
    const OwnedRequestConfig request{gpiod_request_config_new()};
    buffer_.reset(gpiod_edge_event_buffer_new(edges_at_once));
    bool ok = config && request && buffer_;
    for (const Line& line : settings.lines) {
        ok = ok && add_line(config.get(), line);
        offsets_[lines_++] = line.offset;
    }
    if (ok) {
        gpiod_request_config_set_consumer(request.get(), std::string{settings.consumer}.c_str());
        gpiod_request_config_set_event_buffer_size(request.get(), 1024); // the largest that Linux grants
        request_.reset(gpiod_chip_request_lines(chip->get(), request.get(), config.get()));
    }
    const int fd = request_ ? gpiod_line_request_get_fd(request_.get()) : -1;
    if (fd < 0 || ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK) != 0) {
        const Sentence error{"GPIO chip \"", settings.chip,
                             "\" does not grant the lines: ", strerrordesc_np(errno),
                             "; remove a bias or debounce that this chip lacks, or use other lines"};
        close();
        return std::unexpected{error};
    }
    plan_ = *planned;
    fd_ = fd;
    sequence_ = {};
    count_ = {};
    return {};
}

void Lines::close() noexcept {
    if (fd_ >= 0) make_safe();
    request_.reset();
    buffer_.reset();
    fd_ = -1;
    lines_ = 0;
}

EdgeBatch Lines::read_edges(std::span<Edge> edges) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    if (fd_ < 0) return {};
    std::size_t filled = 0;
    for (std::size_t read = edges_at_once; read == edges_at_once && filled < edges.size(); filled += read)
        read = fetch(edges.subspan(filled, std::min(edges_at_once, edges.size() - filled)));
    return judge(edges.first(filled));
}

std::size_t Lines::fetch(std::span<Edge> edges) noexcept TAPPET_REALTIME {
    if (edges.empty()) return 0;
    int n = 0;
    TAPPET_ESCAPE("the driver's own read, which does not block",
                  n = gpiod_line_request_read_edge_events(request_.get(), buffer_.get(), edges.size()));
    if (n < 0) {
        int error = 0;
        TAPPET_ESCAPE("errno is the thread's own", error = errno);
        if (error != EAGAIN && error != EINTR) ++count_.failures;
        return 0;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
        TAPPET_ESCAPE(
            "reads fields of the buffer",
            gpiod_edge_event* event = gpiod_edge_event_buffer_get_event(buffer_.get(), i);
            edges[i].line = index_of(gpiod_edge_event_get_line_offset(event));
            edges[i].rising = gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE;
            edges[i].stamp = at_ns(static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event)));
            edges[i].seqno = static_cast<std::uint32_t>(gpiod_edge_event_get_global_seqno(event)));
    }
    return static_cast<std::size_t>(n);
}

std::uint32_t Lines::index_of(unsigned offset) const noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < lines_; ++i)
        if (offsets_[i] == offset) return i;
    return 0; // the kernel reports only lines that were requested
}

Levels Lines::levels() noexcept TAPPET_REALTIME {
    belongs_to_.used();
    if (fd_ < 0) return {};
    std::array<gpiod_line_value, most_lines> values{};
    int result = 0;
    TAPPET_ESCAPE("one ioctl on the request",
                  result = gpiod_line_request_get_values(request_.get(), values.data()));
    if (result != 0) {
        ++count_.failures;
        return {};
    }
    Levels now{.known = true};
    for (std::size_t i = 0; i < lines_; ++i)
        if (values[i] == GPIOD_LINE_VALUE_ACTIVE) now.mask |= Mask{1} << i;
    return now;
}

bool Lines::write(Mask mask, Mask values) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    std::array<unsigned, most_lines> chosen{};
    std::array<gpiod_line_value, most_lines> to{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < lines_; ++i) {
        if (((mask & plan_.outputs) >> i & 1u) == 0) continue;
        chosen[n] = offsets_[i];
        to[n] = (values >> i & 1u) != 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
        ++n;
    }
    if (fd_ < 0) return false;
    if (n == 0) return true;
    int result = 0;
    TAPPET_ESCAPE("one ioctl on the request",
                  result = gpiod_line_request_set_values_subset(request_.get(), n, chosen.data(), to.data()));
    ++(result == 0 ? count_.writes : count_.failures);
    return result == 0;
}

} // namespace tappet::gpio
