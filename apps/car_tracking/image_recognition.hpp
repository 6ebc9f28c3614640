// Image recognition (thesis 1.4, 5.4): finds the car of one colour in the last image and computes its place
// in the room.
#pragma once

#include "apps/car_tracking/blob.hpp"
#include "apps/car_tracking/sighting.hpp"
#include "kernel/component/component.hpp"
#include "kernel/exchange/data_object.hpp"

namespace tappet::car_tracking {

enum class CarColour : std::uint8_t { red, green, blue };

} // namespace tappet::car_tracking

template <>
inline constexpr auto tappet::names_of<tappet::car_tracking::CarColour> =
    std::array<std::string_view, 3>{"red", "green", "blue"};

namespace tappet::car_tracking {

/// All real-time. It relies on the aim that comes with the image and on the lens at its port.
struct ImageRecognition {
    Input<Image> image;
    Input<Lens> lens;
    Output<Sighting> sighting;
    Output<std::int64_t> images_processed;
    Property<CarColour> colour{CarColour::red};
    Property<double> eye_x{2.0}, eye_y{-0.6}, eye_z{2.0};
    Property<double> car_height{0.05};
    Property<double> car_area{0.045};

    // Commands.
    bool switch_on() noexcept TAPPET_REALTIME { return is_on_ = true; }
    bool switch_off() noexcept TAPPET_REALTIME {
        is_on_ = is_processing_ = false;
        return true;
    }
    /// Processes the last image. Rejected while one is processed, while off, and before the first image.
    bool begin_processing() noexcept TAPPET_REALTIME {
        if (!is_on_ || is_processing_ || image.flow() == Flow::never_written) return false;
        return is_processing_ = true;
    }
    CommandProgress processed() noexcept TAPPET_REALTIME {
        if (is_processing_) return CommandProgress::executing;
        return is_on_ ? CommandProgress::done : CommandProgress::failed;
    }

    // Methods, safe from any thread.
    /// Returns true when the last processed image showed the car.
    bool car_located() const noexcept TAPPET_REALTIME { return last_sighting().located; }
    /// Returns the offset from the camera's aim to the car; zero while the car is not located.
    Aim car_location() const noexcept TAPPET_REALTIME {
        const Sighting seen = last_sighting();
        return seen.located ? seen.offset : Aim{};
    }

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        publish({}, Time{});
        images_processed.write(0);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (!is_processing_) return;
        static_cast<void>(image.read(frame_));
        process();
        images_processed.write(images_processed.last() + 1);
        is_processing_ = false;
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { static_cast<void>(switch_off()); }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&ImageRecognition::image>("image", "", "with the aim it was taken under"),
            input<&ImageRecognition::lens>("lens", "", "of the camera"),
            output<&ImageRecognition::sighting>("sighting", "", "of the image processed last, at its time"),
            output<&ImageRecognition::images_processed>("images_processed", "", "since start"),
            command<&ImageRecognition::switch_on>("start", "ready to process"),
            command<&ImageRecognition::switch_off>("stop", "nothing is processed"),
            command<&ImageRecognition::begin_processing, &ImageRecognition::processed>("process_image", "looks for the car in the last image"),
            method<&ImageRecognition::car_located>("car_located", "the car was in the image processed last", any_thread),
            method<&ImageRecognition::car_location>("car_location", "from where the camera looked to the car", any_thread),
            property<&ImageRecognition::colour>("colour", "", "of the car: 0 red, 1 green, 2 blue"),
            property<&ImageRecognition::eye_x>("eye_x", "m", "where the camera hangs"),
            property<&ImageRecognition::eye_y>("eye_y", "m", "where the camera hangs"),
            property<&ImageRecognition::eye_z>("eye_z", "m", "where the camera hangs", range(0.1, 10)),
            property<&ImageRecognition::car_height>("car_height", "m", "of the car's roof", range(0, 1)),
            property<&ImageRecognition::car_area>("car_area", "m^2", "of the car's roof", range(0.001, 1)));
    }
    // clang-format on

private:
    /// Returns how much brighter the car's colour is than both others; 0 for other colours.
    static std::int64_t likeness(CarColour wanted, const Colour& pixel) noexcept TAPPET_REALTIME {
        const std::array<int, 3> parts{pixel.red, pixel.green, pixel.blue};
        const auto own = static_cast<std::size_t>(wanted);
        const int other = std::max(parts[(own + 1) % 3], parts[(own + 2) % 3]);
        const int excess = parts[own] - other - other / 2 - 20;
        return std::min(std::max(excess, 0), 80); // above 80 it is certainly the car, at any brightness
    }

    void process() noexcept TAPPET_REALTIME {
        const CarColour wanted = colour.get();
        const auto blobs = finder_.find(frame_, [wanted](const Colour& pixel) noexcept
                                        TAPPET_REALTIME { return likeness(wanted, pixel); });
        const Lens through = lens.get();
        const Eigen::Matrix3d axes = axes_at(frame_.aim);
        Sighting best = last_sighting();
        best.located = best.whole = false;
        best.pixels = 0;
        for (const Blob& blob : blobs) {
            if (blob.pixels < least_pixels || blob.pixels <= best.pixels) continue;
            const Eigen::Vector3d ray = ray_of(blob.centre(), through);
            const Eigen::Vector3d direction = axes * ray;
            const auto place = meet_height(eye(), direction, car_height.get());
            if (!place || !fits_car(blob, ray, direction, *place, through)) continue;
            best = {
                true,       place->x(), place->y(), aim_along(direction) - frame_.aim, !blob.touches_border(),
                blob.pixels};
        }
        publish(best, image.stamp());
    }
    /// Returns true when the blob's size fits a car. A pixel covers more floor the farther away it is and the
    /// flatter the view. At the border only a part of the car is visible.
    [[nodiscard]] bool fits_car(const Blob& blob, const Eigen::Vector3d& ray,
                                const Eigen::Vector3d& direction, const Eigen::Vector3d& place,
                                const Lens& through) const noexcept TAPPET_REALTIME {
        const double distance = (place - eye()).norm();
        const double steepness = -direction.z() / direction.norm();
        const double slant = ray.norm(); // a flat sensor magnifies what lies off its axis
        const double side = distance / (through.focal_px * slant);
        const double area = static_cast<double>(blob.pixels) * side * side / (steepness * slant);
        const double least = blob.touches_border() ? 0.25 : 0.35;
        return area > least * car_area.get() && area < 2.0 * car_area.get();
    }
    [[nodiscard]] Eigen::Vector3d eye() const noexcept TAPPET_REALTIME {
        return {eye_x.get(), eye_y.get(), eye_z.get()};
    }
    [[nodiscard]] Sighting last_sighting() const noexcept TAPPET_REALTIME {
        Sighting seen{};
        std::uint64_t generation = 0;
        static_cast<void>(shown_.read(seen, generation));
        return seen;
    }
    void publish(const Sighting& seen, Time taken) noexcept TAPPET_REALTIME {
        shown_.write(seen);
        sighting.write(seen, taken);
    }

    static constexpr std::int64_t least_pixels = 6;

    DataObject<Sighting> shown_{};
    bool is_on_ = false;
    bool is_processing_ = false;
    Image frame_{};
    BlobFinder finder_{};
};

} // namespace tappet::car_tracking
