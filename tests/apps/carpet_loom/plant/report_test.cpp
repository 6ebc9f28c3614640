// The report's arithmetic and its JSON, and the shapes the physics is made of.
#include "apps/carpet_loom/plant/report.hpp"
#include "apps/carpet_loom/plant/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tappet::loom {
namespace {

TEST(Histogram, gives_percentiles_to_a_hundredth_and_the_exact_maximum) {
    ErrorHistogram histogram;
    EXPECT_EQ(histogram.percentile_deg(99), 0.0);
    for (int i = 1; i <= 100; ++i) histogram.add(i % 2 == 0 ? 0.1 * i : -0.1 * i);
    histogram.add(123.456);
    EXPECT_EQ(histogram.samples(), 101U);
    EXPECT_NEAR(histogram.percentile_deg(50), 5.1, 0.011);
    EXPECT_NEAR(histogram.percentile_deg(99), 10.0, 0.011);
    EXPECT_EQ(histogram.max_deg(), 123.456);
}

TEST(Json, holds_every_stop_and_fits_the_buffer_of_a_summary) {
    Report report;
    report.stops_total = 1'000'000;
    Stop stop{StopCause::operator_stop, 123'456'789'012'345, ~std::uint64_t{0}, 309.9994, -0.0006, 47.25};
    while (report.stops.push(stop)) {
    }
    while (report.patterns.push({0xffff, ~std::uint64_t{0}, ~std::uint64_t{0}})) {
    }
    std::string text(64 * 1024, '\0');
    JsonText json{text};
    write_json(report, json);
    ASSERT_GT(json.size(), 0U);
    text.resize(json.size());
    EXPECT_NE(text.find("\"cause\": \"operator\", \"angle_deg\": 309.999, \"error_deg\": -0.0006"),
              std::string::npos);
    std::size_t stops = 0;
    for (std::size_t at = 0; (at = text.find("\"cause\"", at)) != std::string::npos; ++at) ++stops;
    EXPECT_EQ(stops, Report::most_stops);
}

TEST(Shapes, have_a_sine_that_is_close_to_the_true_one) {
    for (int i = -3000; i <= 3000; ++i) {
        const double turns = i / 1000.0;
        EXPECT_NEAR(sine_of_turns(turns), std::sin(turns * 6.283185307179586), 4e-6) << turns;
    }
}

TEST(Shapes, wrap_angles_into_their_ranges) {
    EXPECT_EQ(wrapped_deg(190.0), -170.0);
    EXPECT_EQ(wrapped_deg(-180.0), 180.0);
    EXPECT_EQ(wrapped_deg(180.0), 180.0);
    EXPECT_EQ(wrapped_deg(725.0), 5.0);
    EXPECT_EQ(angle_of_position(-10.0), 350.0);
    EXPECT_EQ(angle_of_position(720.0), 0.0);
    EXPECT_EQ(floor_to_int(-0.5), -1);
    EXPECT_EQ(floor_to_int(-2.0), -2);
    EXPECT_EQ(round_to_int(-2.5), -3);
}

} // namespace
} // namespace tappet::loom
