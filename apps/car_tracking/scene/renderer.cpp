// Draws the room with one ray per pixel and moment.
#include "apps/car_tracking/scene/renderer.hpp"

#include <algorithm>
#include <array>

namespace tappet::car_tracking {

namespace {

constexpr std::size_t pixels = image_columns * image_rows;

/// Returns the colour of the floor and of the flat things on it.
Colour floor_colour(double x, double y) {
    if (room::mark.holds(x, y)) return room::mark.colour;
    if (x < -1.0 || x > room::width + 1.0 || y > room::depth + 0.8) return room::wall;
    for (const auto& ball : room::balls)
        if (ball.holds(x, y)) return ball.colour;
    const auto tile = static_cast<int>(std::floor(2.0 * x)) + static_cast<int>(std::floor(2.0 * y));
    return tile % 2 == 0 ? room::floor_light : room::floor_dark;
}

/// Finds the first thing that a ray from the camera meets, from above.
class View {
public:
    View(const Aim& aim, const CarPose& car)
        : axes_{axes_at(aim)},
          eye_{room::eye()},
          car_{car},
          cos_{std::cos(car.heading)},
          sin_{std::sin(car.heading)} {}

    [[nodiscard]] Colour at(double x, double y) const {
        const Eigen::Vector3d ray{axes_ * Eigen::Vector3d{x, y, 1.0}};
        if (ray.z() >= -0.02) return room::wall;
        const double per_metre = -1.0 / ray.z();
        const auto meets = [&](double height) {
            const double reach = (eye_.z() - height) * per_metre;
            return std::pair{eye_.x() + reach * ray.x(), eye_.y() + reach * ray.y()};
        };
        const auto [roof_x, roof_y] = meets(room::tunnel_height);
        if (room::tunnel.holds(roof_x, roof_y)) return room::tunnel_roof;
        const auto [top_x, top_y] = meets(room::car_height);
        if (!car_.lifted && is_car(top_x, top_y)) return room::car_body;
        const auto [floor_x, floor_y] = meets(0.0);
        return floor_colour(floor_x, floor_y);
    }

private:
    [[nodiscard]] bool is_car(double x, double y) const {
        const double along = cos_ * (x - car_.x) + sin_ * (y - car_.y);
        const double across = -sin_ * (x - car_.x) + cos_ * (y - car_.y);
        return std::abs(along) <= 0.5 * room::car_length && std::abs(across) <= 0.5 * room::car_width;
    }

    Eigen::Matrix3d axes_;
    Eigen::Vector3d eye_;
    CarPose car_;
    double cos_, sin_;
};

std::uint8_t shade(int sum, int noise) {
    return static_cast<std::uint8_t>(std::clamp(sum / Renderer::moments + noise, 0, 255));
}

} // namespace

Renderer::Renderer(const Lens& lens) : sums_(pixels) {
    constexpr std::array<Flat, moments> within{{{-0.25, -0.25}, {0.25, 0.25}, {0.25, -0.25}, {-0.25, 0.25}}};
    rays_.reserve(moments * pixels);
    for (const Flat& part : within)
        for (std::size_t row = 0; row < image_rows; ++row)
            for (std::size_t column = 0; column < image_columns; ++column) {
                const Eigen::Vector3d ray =
                    ray_of({static_cast<double>(column) + part.x, static_cast<double>(row) + part.y}, lens);
                rays_.push_back({ray.x(), ray.y()});
            }
}

void Renderer::add(int moment, const Aim& aim, const CarPose& car) {
    const View view{aim, car};
    const Flat* ray = rays_.data() + static_cast<std::size_t>(moment) * pixels;
    for (Sum& sum : sums_) {
        const Colour seen = view.at(ray->x, ray->y);
        sum.red += seen.red;
        sum.green += seen.green;
        sum.blue += seen.blue;
        ++ray;
    }
}

void Renderer::finish(Random& noise, Picture& into) const {
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::uint64_t drawn = noise.next();
        // Two bytes a channel: triangular noise with a standard deviation of about 6.5 steps.
        const auto grain = [drawn](int channel) {
            const auto low = static_cast<int>(drawn >> (16 * channel) & 0xff);
            const auto high = static_cast<int>(drawn >> (16 * channel + 8) & 0xff);
            return (low + high - 255) / 16;
        };
        into.pixels[i] = {shade(sums_[i].red, grain(0)), shade(sums_[i].green, grain(1)),
                          shade(sums_[i].blue, grain(2))};
    }
}

} // namespace tappet::car_tracking
