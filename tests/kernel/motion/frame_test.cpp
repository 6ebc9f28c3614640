// Frames, twists and wrenches: identities that hold for any numbers, and code that must not compile.
#include "kernel/exchange/words.hpp"
#include "kernel/motion/twist.hpp"
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/motion/random_motion.hpp"

#include <numbers>

namespace tappet::motion::test {
namespace {

struct A;
struct B;
struct C;
struct D;

struct Frames : tappet::test::Seeded {
    template <class Body, class Reference, class At, class In>
    Twist<Body, Reference, At, In> any_twist() {
        const Eigen::Vector3d linear = any_vector(random, 3.0);
        const Eigen::Vector3d angular = any_vector(random, 3.0);
        return {linear, angular};
    }
    template <class Body, class At, class In>
    Wrench<Body, At, In> any_wrench() {
        const Eigen::Vector3d force = any_vector(random, 100.0);
        const Eigen::Vector3d torque = any_vector(random, 10.0);
        return {force, torque};
    }
};

TEST_F(Frames, compose_and_invert) {
    for (int i = 0; i < 100; ++i) {
        const auto ab = any_frame<A, B>(random);
        const auto bc = any_frame<B, C>(random);
        const Point<C> p{any_vector(random, 2.0)};
        EXPECT_NEAR((ab * bc * p - ab * (bc * p)).along.norm(), 0.0, 1e-14);
        EXPECT_NEAR((inverse(ab) * (ab * (bc * p)) - bc * p).along.norm(), 0.0, 1e-14);
        const Frame<A, A> nowhere = ab * inverse(ab);
        EXPECT_NEAR((nowhere.rotation - Eigen::Matrix3d::Identity()).norm() + nowhere.position.norm(), 0.0,
                    1e-14);
    }
}

TEST_F(Frames, leave_a_vector_without_a_position) {
    const auto ab = any_frame<A, B>(random);
    const Point<B> from{any_vector(random, 1.0)};
    const Vector<B> way{any_vector(random, 1.0)};
    EXPECT_NEAR((ab * (from + way) - (ab * from + ab * way)).along.norm(), 0.0, 1e-14);
}

TEST_F(Frames, convert_to_and_from_rotation_vectors) {
    for (const double angle :
         {0.0, 1e-12, 1e-6, 0.9e-4, 1.1e-4, 0.1, 1.0, 2.0, 3.0, std::numbers::pi - 1e-9}) {
        const Eigen::Vector3d v = any_vector(random, 1.0).normalized() * angle;
        const Eigen::Matrix3d m = rotation_about(v);
        EXPECT_NEAR((m * m.transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 2e-15) << angle;
        EXPECT_NEAR((rotation_vector(m) - v).norm(), 0.0, 1e-14) << angle;
        EXPECT_NEAR((m - Eigen::AngleAxisd(angle, v.normalized()).matrix()).norm() * (angle > 0.0), 0.0,
                    2e-15)
            << angle;
    }
    const Eigen::Vector3d half = any_vector(random, 1.0).normalized() * std::numbers::pi;
    EXPECT_NEAR((rotation_about(rotation_vector(rotation_about(half))) - rotation_about(half)).norm(), 0.0,
                1e-14);
}

TEST_F(Frames, transform_twists_and_wrenches_at_constant_power) {
    for (int i = 0; i < 100; ++i) {
        const auto ab = any_frame<A, B>(random);
        const auto twist = any_twist<D, C, B, B>();
        const auto wrench = any_wrench<D, B, B>();
        const double watts = power(wrench, twist);
        EXPECT_NEAR(power(ab * wrench, ab * twist), watts, 1e-11);
        EXPECT_NEAR(power(turned(ab, wrench), turned(ab, twist)), watts, 1e-11);
        const Vector<B> way{any_vector(random, 2.0)};
        EXPECT_NEAR(power(moved<C>(wrench, way), moved<C>(twist, way)), watts, 1e-11);
    }
}

TEST_F(Frames, add_twists_through_an_intermediate_body) {
    const auto b = any_twist<B, A, D, D>();
    const auto c = any_twist<C, B, D, D>();
    const Twist<C, A, D, D> sum = b + c;
    const Twist<A, C, D, D> back = -c + -b;
    EXPECT_EQ(sum.linear, -back.linear);
    EXPECT_EQ(sum.angular, -back.angular);
}

TEST_F(Frames, differ_by_the_twist_of_their_motion) {
    const auto from = any_frame<A, B>(random);
    const auto to = any_frame<A, B>(random);
    const auto way = difference(from, to);
    EXPECT_NEAR((from.position + way.linear - to.position).norm(), 0.0, 1e-14);
    EXPECT_NEAR((rotation_about(way.angular) * from.rotation - to.rotation).norm(), 0.0, 1e-13);
}

// A quantity of one frame cannot be used in another.
template <class X, class Y>
concept Multiply = requires(X x, Y y) { x * y; };
template <class X, class Y>
concept Add = requires(X x, Y y) { x + y; };
static_assert(Multiply<Frame<A, B>, Frame<B, C>> && !Multiply<Frame<A, B>, Frame<A, C>>);
static_assert(Multiply<Frame<A, B>, Point<B>> && !Multiply<Frame<A, B>, Point<A>>);
static_assert(Add<Point<A>, Vector<A>> && !Add<Point<A>, Vector<B>> && !Add<Point<A>, Point<A>>);
static_assert(Add<Twist<B, A, D, D>, Twist<C, B, D, D>> && !Add<Twist<B, A, D, D>, Twist<C, A, D, D>>);
static_assert(!Add<Twist<B, A, C, D>, Twist<C, B, D, D>>, "at two points");
static_assert(!Add<Wrench<A, B, C>, Wrench<A, B, D>>, "along the axes of two frames");
static_assert(Multiply<Frame<A, B>, Twist<C, D, B, B>> && !Multiply<Frame<A, B>, Twist<C, D, C, B>>);

// They cross between threads, and a connection distinguishes their references.
static_assert(Exchangeable<Frame<A, B>> && Exchangeable<Twist<B, A, B, A>> && Exchangeable<Wrench<B, B, A>>);
static_assert(Exchangeable<Point<A>> && Exchangeable<Vector<A>>);

TEST(FramesOnPorts, are_records_of_matrices_with_distinct_references) {
    const TypeTag& tag = *type_id<Frame<A, B>>;
    ASSERT_EQ(tag.kind, ValueKind::record);
    ASSERT_EQ(tag.fields.size(), 2u);
    EXPECT_EQ(tag.fields[0].name, "rotation");
    EXPECT_EQ(tag.fields[0].type->rows * tag.fields[0].type->columns, 9u);
    EXPECT_EQ(tag.fields[1].unit, "m");
    EXPECT_EQ((type_id<Wrench<B, B, A>>)->fields[1].name, "torque");
    EXPECT_NE((type_id<Frame<A, B>>), (type_id<Frame<A, C>>));
}

} // namespace
} // namespace tappet::motion::test
