// Thesis 1.4, 5.4: the parts of the car tracker's vision: lens and rays, blobs, the calibration, and the two
// components against the simulated room, each alone.
#include "apps/car_tracking/camera.hpp"
#include "apps/car_tracking/image_recognition.hpp"
#include "apps/car_tracking/scene/scene.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace tappet::car_tracking {
namespace {

/// Camera and recognition before the room, run by hand in steps of 5 ms.
class Eyes {
public:
    explicit Eyes(std::uint64_t seed) : scene_{std::make_unique<Scene>(seed)} {
        const auto link = [this]<class T>(Input<T>& input, Output<T>& output) {
            PortAccess::data<T>.set_clock(&input, true, &now_);
            PortAccess::data<T>.set_clock(&output, false, &now_);
            PortAccess::data<T>.link_local(&input, &output, nullptr);
        };
        link(recognition().image, camera().image);
        link(recognition().lens, camera().lens);
        link(camera().picture, sensor_->picture);
        link(camera().sensor_faulted, sensor_->faulted);
        link(camera().pan_counts, sensor_->pan[0]);
        link(camera().pan_index, sensor_->pan[1]);
        link(camera().pan_index_seen, sensor_->pan[2]);
        link(camera().tilt_counts, sensor_->tilt[0]);
        link(camera().tilt_index, sensor_->tilt[1]);
        link(camera().tilt_index_seen, sensor_->tilt[2]);
        PortAccess::data<Sighting>.set_clock(&recognition().sighting, false, &now_);
        sensor_->faulted.write(false);
        camera().start({});
        recognition().start({});
        step();
    }
    /// Runs until the command has ended; returns how.
    CommandProgress run(CommandProgress (Camera::*progress)() noexcept TAPPET_REALTIME,
                        Duration at_most = 20s) {
        for (const Time end = now_ + at_most; now_ < end;) {
            step();
            if (const auto how = (camera().*progress)(); how != CommandProgress::executing) return how;
        }
        return CommandProgress::executing;
    }
    void step() {
        for (const Time end = now_ + 5ms; now_ < end;) {
            now_ += Scene::step;
            scene_->advance(now_);
            if (const Picture* picture = scene_->new_image())
                sensor_->picture.write(*picture, now_ - Scene::exposure / 2 - Scene::readout);
        }
        write(sensor_->pan, scene_->pan());
        write(sensor_->tilt, scene_->tilt());
        camera().step({now_, now_, 5ms});
        recognition().step({now_, now_, 5ms});
        scene_->drive(camera().drives_on.last() != 0, camera().pan_speed.last(), camera().tilt_speed.last());
    }
    /// The truth of the image processed last.
    const Truth& pictured() {
        return scene_->pictured(*PortAccess::data<Sighting>.places(&recognition().sighting, false).stamp);
    }
    void blind(bool faulted) { sensor_->faulted.write(faulted); }
    bool calibrate() {
        return recognition().switch_on() && camera().switch_on() && camera().begin_calibration() &&
               run(&Camera::calibrated) == CommandProgress::done;
    }
    bool look_at(Aim aim) { return camera().begin_move(aim) && run(&Camera::moved) == CommandProgress::done; }
    /// Processes one image.
    Sighting look() {
        EXPECT_TRUE(camera().begin_fetch());
        EXPECT_EQ(run(&Camera::fetched), CommandProgress::done);
        EXPECT_TRUE(recognition().begin_processing());
        step();
        return recognition().sighting.last();
    }
    Camera& camera() { return *camera_; }
    ImageRecognition& recognition() { return *recognition_; }
    Scene& scene() { return *scene_; }

private:
    /// The outputs of the two drivers.
    struct Drivers {
        Output<Picture> picture;
        Output<bool> faulted;
        std::array<Output<std::int64_t>, 3> pan, tilt;
    };
    static void write(std::array<Output<std::int64_t>, 3>& axis, const AxisReading& reading) {
        axis[0].write(reading.counts);
        axis[1].write(reading.index_counts);
        axis[2].write(reading.is_index_seen ? 1 : 0);
    }

    std::unique_ptr<Scene> scene_;
    std::unique_ptr<Drivers> sensor_ = std::make_unique<Drivers>();
    std::unique_ptr<Camera> camera_ = std::make_unique<Camera>();
    std::unique_ptr<ImageRecognition> recognition_ = std::make_unique<ImageRecognition>();
    Time now_{};
};

constexpr std::array<std::uint64_t, 6> seeds{1, 2, 3, 11, 17, 99};

TEST(Geometry, a_pixel_maps_to_its_ray_and_back) {
    const Lens lens{153.0, -0.14};
    for (double x = 0; x < image_columns; x += 13.0)
        for (double y = 0; y < image_rows; y += 7.0) {
            const auto back = pixel_of(ray_of({x, y}, lens), lens);
            ASSERT_TRUE(back);
            EXPECT_NEAR(back->x(), x, 1e-6);
            EXPECT_NEAR(back->y(), y, 1e-6);
        }
    EXPECT_FALSE(pixel_of({0.1, 0.2, -1.0}, lens)) << "it lies behind the camera";
}

TEST(Geometry, axes_are_right_handed_and_look_along_the_aim) {
    for (double pan = -70; pan <= 70; pan += 35)
        for (double tilt = -80; tilt <= 20; tilt += 20) {
            const Eigen::Matrix3d axes = axes_at({pan, tilt});
            EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
            EXPECT_NEAR((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
            const Aim back = aim_along(axes.col(2));
            EXPECT_NEAR(back.pan, pan, 1e-9);
            EXPECT_NEAR(back.tilt, tilt, 1e-9);
        }
}

TEST(Geometry, a_ray_that_rises_never_meets_the_floor) {
    EXPECT_FALSE(meet_height({0, 0, 2}, {0, 1, 0.1}, 0.0));
    EXPECT_FALSE(meet_height({0, 0, 2}, {0, 1, 0}, 0.0));
    EXPECT_FALSE(meet_height({0, 0, 2}, {0, 1, -1}, 3.0)) << "it is above the eye";
    EXPECT_NEAR(meet_height({0, 0, 2}, {0, 1, -1}, 0.5)->y(), 1.5, 1e-12);
}

TEST(Blobs, pixels_that_touch_at_a_corner_form_one_blob) {
    Image image;
    for (const auto& [row, column] : {std::pair{10u, 10u}, {11u, 11u}, {10u, 12u}, {9u, 13u}, {50u, 3u}})
        image.pixels[row * image_columns + column].red = 200;
    BlobFinder finder;
    const auto blobs =
        finder.find(image, [](const Colour& c) noexcept TAPPET_REALTIME { return int{c.red}; });
    ASSERT_EQ(blobs.size(), 2u);
    EXPECT_EQ(blobs[0].pixels, 4);
    EXPECT_NEAR(blobs[0].centre().x(), 11.5, 1e-12);
    EXPECT_NEAR(blobs[0].centre().y(), 10.0, 1e-12);
    EXPECT_FALSE(blobs[0].touches_border());
    EXPECT_EQ(blobs[1].pixels, 1);
}

TEST(Blobs, a_comb_of_many_labels_is_one_blob_and_the_number_is_bounded) {
    const auto weigh = [](const Colour& c) noexcept TAPPET_REALTIME { return int{c.red}; };
    auto image = std::make_unique<Image>();
    for (std::size_t row = 0; row < image_rows; ++row) // teeth that only the last row joins
        for (std::size_t column = 0; column < image_columns; column += 2)
            image->pixels[row * image_columns + column].red = 1;
    for (std::size_t column = 0; column < image_columns; ++column)
        image->pixels[(image_rows - 1) * image_columns + column].red = 1;
    BlobFinder finder;
    ASSERT_EQ(finder.find(*image, weigh).size(), 1u);
    EXPECT_EQ(finder.find(*image, weigh)[0].pixels, 80 * 120 + 80);
    *image = {};
    for (std::size_t row = 0; row < image_rows; row += 2)
        for (std::size_t column = 0; column < image_columns; column += 2)
            image->pixels[row * image_columns + column].red = 1;
    EXPECT_EQ(finder.find(*image, weigh).size(), BlobFinder::most_blobs);
}

TEST(Calibration, finds_the_lens_that_made_the_views) {
    const Lens lens{157.0, -0.13};
    const Aim mark{0.7, -26.1};
    LensCalibration calibration;
    calibration.begin();
    for (const Aim& aim : {Aim{0, -27}, {18, -27}, {-18, -27}, {0, -15}, {0, -39}, {15, -16}, {-15, -38}})
        calibration.add({aim, *pixel_of(axes_at(aim).transpose() * axes_at(mark).col(2), lens)});
    const auto fit = calibration.fit({150.0, 0.0}, {0, -27});
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->lens.focal_px, lens.focal_px, 1e-3);
    EXPECT_NEAR(fit->lens.k1, lens.k1, 1e-5);
    EXPECT_NEAR(fit->mark.pan, mark.pan, 1e-4);
    EXPECT_LT(fit->error_px, 1e-4);
}

TEST(Calibration, refuses_too_few_uninformative_or_contradicting_views) {
    LensCalibration calibration;
    calibration.begin();
    for (int i = 0; i < 5; ++i) calibration.add({{4.0 * i, -27}, {80.0 - 10.0 * i, 60}});
    EXPECT_FALSE(calibration.fit({150, 0}, {0, -27})) << "five views";
    calibration.begin();
    for (int i = 0; i < 9; ++i) calibration.add({{0, -27}, image_centre()});
    EXPECT_FALSE(calibration.fit({150, 0}, {0, -27})) << "always the same view";
    calibration.begin();
    for (int i = 0; i < 9; ++i) calibration.add({{i % 3 * 10.0, -27.0 - i}, {i * 37 % 160, i * 53 % 120}});
    EXPECT_FALSE(calibration.fit({150, 0}, {0, -27})) << "another mark in each view";
}

TEST(Camera, learns_its_lens_and_where_it_looks) {
    for (const std::uint64_t seed : seeds) {
        Eyes eyes{seed};
        ASSERT_TRUE(eyes.calibrate()) << "seed " << seed;
        const Lens learned = eyes.camera().lens.last();
        const Lens real = eyes.scene().lens();
        EXPECT_GT(std::abs(150.0 / real.focal_px - 1.0), 0.025) << "the data sheet would have done";
        EXPECT_NEAR(learned.focal_px / real.focal_px, 1.0, 0.004) << "seed " << seed;
        EXPECT_NEAR(learned.k1, real.k1, 0.05) << "seed " << seed;
        EXPECT_LT(eyes.camera().calibration_error_px.last(), 0.2);
        const Aim looks = eyes.scene().truth().aim;
        EXPECT_NEAR(eyes.camera().get_position().pan, looks.pan, 0.02);
        EXPECT_NEAR(eyes.camera().get_position().tilt, looks.tilt, 0.02);
    }
}

TEST(Camera, refuses_commands_that_conflict_with_its_state) {
    Eyes eyes{5};
    Camera& camera = eyes.camera();
    EXPECT_FALSE(camera.begin_fetch()) << "it is off";
    EXPECT_FALSE(camera.begin_move({1, 1})) << "it is off";
    ASSERT_TRUE(camera.switch_on());
    EXPECT_FALSE(camera.begin_move({200, 0})) << "no head turns that far";
    EXPECT_FALSE(camera.begin_move({std::nan(""), 0}));
    ASSERT_TRUE(camera.begin_move({1, 1}));
    EXPECT_FALSE(camera.begin_move({2, 2})) << "it moves";
    EXPECT_FALSE(camera.begin_calibration()) << "it moves";
    EXPECT_EQ(eyes.run(&Camera::moved), CommandProgress::done);
    ASSERT_TRUE(camera.begin_calibration());
    EXPECT_FALSE(camera.begin_fetch()) << "it is calibrated";
    EXPECT_FALSE(camera.begin_calibration()) << "it is calibrated";
    ASSERT_TRUE(camera.switch_off());
    EXPECT_EQ(camera.calibrated(), CommandProgress::failed) << "switched off meanwhile";
    EXPECT_FALSE(camera.is_calibrated());
}

TEST(Camera, fails_its_command_and_stands_while_its_sensor_is_silent) {
    Eyes eyes{5};
    ASSERT_TRUE(eyes.camera().switch_on());
    ASSERT_TRUE(eyes.camera().begin_move({20, 1}));
    for (int i = 0; i < 5; ++i) eyes.step();
    EXPECT_NE(eyes.camera().pan_speed.last(), 0.0);
    eyes.blind(true);
    EXPECT_EQ(eyes.run(&Camera::moved), CommandProgress::failed);
    EXPECT_EQ(eyes.camera().pan_speed.last(), 0.0);
    EXPECT_FALSE(eyes.camera().begin_fetch());
    eyes.blind(false);
    eyes.step();
    EXPECT_TRUE(eyes.camera().begin_fetch());
    EXPECT_EQ(eyes.run(&Camera::fetched), CommandProgress::done);
}

TEST(Recognition, locates_the_car_in_the_room_to_four_centimetres) {
    for (const std::uint64_t seed : seeds) {
        Eyes eyes{seed};
        ASSERT_TRUE(eyes.calibrate());
        int seen = 0;
        for (int i = 0; i < 20; ++i) {
            for (int wait = 0; wait < 200; ++wait) eyes.step();
            const CarPose car = eyes.scene().truth().car;
            if (car.lifted) continue; // nobody knows where it will stand
            ASSERT_TRUE(eyes.look_at(aim_along(Eigen::Vector3d{car.x, car.y, 0} - room::eye())));
            const Sighting sighting = eyes.look();
            const Truth truth = eyes.pictured();
            if (truth.car_hidden || room::tunnel.holds(truth.car.x, truth.car.y, 0.35)) continue;
            ASSERT_TRUE(sighting.located) << "seed " << seed << " look " << i;
            const double error = std::hypot(sighting.x - truth.car.x, sighting.y - truth.car.y);
            EXPECT_LT(error, 0.04) << "seed " << seed << " look " << i;
            ++seen;
        }
        EXPECT_GE(seen, 8) << "seed " << seed;
    }
}

TEST(Recognition, does_not_mistake_a_ball_for_the_car) {
    Eyes eyes{3};
    ASSERT_TRUE(eyes.calibrate());
    for (const auto& ball : room::balls) {
        ASSERT_TRUE(eyes.look_at(aim_along(Eigen::Vector3d{ball.x, ball.y, 0} - room::eye())));
        const Sighting sighting = eyes.look();
        EXPECT_TRUE(!sighting.located || std::hypot(sighting.x - ball.x, sighting.y - ball.y) > 0.15);
    }
}

} // namespace
} // namespace tappet::car_tracking
