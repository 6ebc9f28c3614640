// A driver may round what it is asked for: each answer is compared with the wish.
#include "drivers/camera/offers.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <linux/videodev2.h>
#include <sys/ioctl.h>

namespace tappet::camera {

namespace {

constexpr unsigned most_offers = 64; // of each list; a driver that never ends it would hold up the start

std::uint32_t code_of(Format format) {
    const auto& code = row_of(format).code;
    return v4l2_fourcc(code[0], code[1], code[2], code[3]);
}

/// Visits what the device enumerates.
template <class Entry, class Visit>
void each_offer(int fd, unsigned long what, Entry entry, const Visit& visit) {
    for (entry.index = 0; entry.index < most_offers && request(fd, what, &entry) == 0; ++entry.index)
        visit(entry);
}

/// Returns a fault if the device does not offer the format.
Sentence check_format(int fd, Format wanted) {
    bool found = false;
    Sentence offers;
    v4l2_fmtdesc asked{};
    asked.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    each_offer(fd, VIDIOC_ENUM_FMT, asked, [&](const auto& each) {
        found |= each.pixelformat == code_of(wanted);
        offers.add(offers.empty() ? "" : ", ");
        for (const int shift : {0, 8, 16, 24})
            offers.add(
                std::string_view{std::array{static_cast<char>(each.pixelformat >> shift & 0x7f)}.data(), 1});
        for (const FormatRow& row : formats)
            if (each.pixelformat == v4l2_fourcc(row.code[0], row.code[1], row.code[2], row.code[3]))
                offers.add(" (").add(row.name).add(")");
    });
    if (found) return {};
    return Sentence{"it does not offer ", row_of(wanted).name, ", it offers ",
                    offers.empty() ? "nothing" : offers.view(),
                    "; write one that has a name here as pixels(...) in the board's row"};
}

/// Returns what sizes the device offers in the format; empty when it does not say.
Sentence offered_sizes(int fd, Format format) {
    Sentence offers;
    v4l2_frmsizeenum asked{};
    asked.pixel_format = code_of(format);
    each_offer(fd, VIDIOC_ENUM_FRAMESIZES, asked, [&](const auto& each) {
        offers.add(offers.empty() ? "" : ", ");
        if (each.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
            offers.add(Sentence{each.discrete.width, " x ", each.discrete.height}.view());
            return;
        }
        const auto& range = each.stepwise;
        offers.add(Sentence{range.min_width, " x ", range.min_height, " to ", range.max_width, " x ",
                            range.max_height, " in steps of ", range.step_width, " x ", range.step_height}
                       .view());
    });
    return offers;
}

Sentence set_size(int fd, const CameraFacts& wanted, std::size_t& row_bytes) {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    v4l2_pix_format& picture = format.fmt.pix;
    picture.width = static_cast<std::uint32_t>(wanted.size.columns);
    picture.height = static_cast<std::uint32_t>(wanted.size.rows);
    picture.pixelformat = code_of(wanted.format);
    picture.field = V4L2_FIELD_NONE;
    if (const int error = request(fd, VIDIOC_S_FMT, &format); error != 0)
        return Sentence{"it cannot be set to a format: ", std::string_view{std::strerror(error)},
                        "; end the program that uses it"};
    if (picture.width != wanted.size.columns || picture.height != wanted.size.rows) {
        const Sentence offers = offered_sizes(fd, wanted.format);
        return Sentence{"it does not offer ",
                        wanted.size.columns,
                        " x ",
                        wanted.size.rows,
                        " in ",
                        row_of(wanted.format).name,
                        ", it offers ",
                        offers.empty() ? "nearest " : "",
                        offers,
                        offers.empty() ? Sentence{picture.width, " x ", picture.height} : Sentence{},
                        "; write one of these as frames(...) in the board's row"};
    }
    if (picture.pixelformat != code_of(wanted.format))
        return Sentence{"it does not stream ", row_of(wanted.format).name,
                        ", though it offers it; write another pixels(...) in the board's row"};
    if (picture.field != V4L2_FIELD_NONE)
        return Sentence{
            "its images are interlaced in this size; write another frames(...) in the board's row"};
    row_bytes =
        std::max<std::size_t>(picture.bytesperline, wanted.size.columns * row_of(wanted.format).bytes);
    return {};
}

double rate_of(const v4l2_fract& interval) {
    return interval.numerator == 0 ? 0.0 : static_cast<double>(interval.denominator) / interval.numerator;
}

Sentence set_rate(int fd, const CameraFacts& wanted) {
    v4l2_streamparm asked{};
    asked.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    asked.parm.capture.timeperframe = {1, wanted.per_second};
    const int error = request(fd, VIDIOC_S_PARM, &asked);
    const double rate = rate_of(asked.parm.capture.timeperframe);
    const auto is = [](double found, double whole) { return std::abs(found - whole) < 0.01 * whole; };
    if (error == 0 && is(rate, wanted.per_second)) return {};
    Sentence offers;
    v4l2_frmivalenum offered{};
    offered.pixel_format = code_of(wanted.format);
    offered.width = static_cast<std::uint32_t>(wanted.size.columns);
    offered.height = static_cast<std::uint32_t>(wanted.size.rows);
    each_offer(fd, VIDIOC_ENUM_FRAMEINTERVALS, offered, [&](const auto& each) {
        const bool is_one = each.type == V4L2_FRMIVAL_TYPE_DISCRETE;
        const double one = is_one ? rate_of(each.discrete) : 0.0;
        if (is_one && !is(one, std::round(one))) return; // no board can say it
        offers.add(offers.empty() ? "" : ", ");
        if (is_one) {
            offers.add(Sentence{std::lround(one)}.view());
            return;
        }
        offers.add(
            Sentence{std::lround(rate_of(each.stepwise.max)), " to ", std::lround(rate_of(each.stepwise.min))}
                .view());
    });
    if (offers.empty()) offers.add(Sentence{std::lround(rate)}.view());
    return Sentence{"it does not offer ", wanted.per_second, " frames per second in this size, it offers ",
                    offers, "; write one of these as the third number of frames(...) in the board's row"};
}

Sentence set_exposure(int fd, Duration time) {
    if (time == Duration::zero()) return {};
    v4l2_control by_hand{.id = V4L2_CID_EXPOSURE_AUTO, .value = V4L2_EXPOSURE_MANUAL};
    v4l2_control exposure{.id = V4L2_CID_EXPOSURE_ABSOLUTE, .value = static_cast<std::int32_t>(time / 100us)};
    static_cast<void>(request(fd, VIDIOC_S_CTRL, &by_hand)); // a camera without automatic exposure lacks it
    const int error = request(fd, VIDIOC_S_CTRL, &exposure);
    if (error == 0) return {};
    v4l2_queryctrl range{};
    range.id = V4L2_CID_EXPOSURE_ABSOLUTE;
    if (request(fd, VIDIOC_QUERYCTRL, &range) != 0)
        return Sentence{"it has no exposure that can be set; remove exposure(...) from the binding"};
    return Sentence{"it does not take an exposure of ",
                    time / 1us,
                    " us, it offers ",
                    range.minimum * 100L,
                    " to ",
                    range.maximum * 100L,
                    " us; correct exposure(...) in the binding"};
}

} // namespace

int request(int fd, unsigned long what, void* argument) noexcept {
    int result = -1;
    do result = ::ioctl(fd, what, argument);
    while (result < 0 && errno == EINTR);
    return result < 0 ? errno : 0;
}

std::expected<std::size_t, Sentence> set_picture(int fd, const CameraFacts& wanted) {
    std::size_t row_bytes = 0;
    Sentence fault = check_format(fd, wanted.format);
    if (fault.empty()) fault = set_size(fd, wanted, row_bytes);
    if (fault.empty()) fault = set_rate(fd, wanted);
    if (fault.empty()) fault = set_exposure(fd, wanted.exposure);
    if (!fault.empty()) return std::unexpected(fault);
    return row_bytes;
}

} // namespace tappet::camera
