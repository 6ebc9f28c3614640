// Words: atomic words carry a value unchanged, byte by byte.
#include "kernel/exchange/words.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

namespace {

using namespace tappet;

struct WithEigenInside {
    Eigen::Vector3d force;
};

struct Stated {
    Eigen::Vector3d force;
};

struct Odd {
    std::array<std::uint8_t, 13> bytes;
};

} // namespace

static_assert(Exchangeable<double> && Exchangeable<Odd>);
static_assert(Exchangeable<Eigen::Vector3d> && Exchangeable<Eigen::Matrix<float, 6, 6>> &&
              Exchangeable<Eigen::Array<int, 4, 1>>);
static_assert(!Exchangeable<Eigen::VectorXd> && !Exchangeable<Eigen::Map<Eigen::Vector3d>>,
              "what points to its numbers cannot be copied as bytes");
static_assert(!Exchangeable<std::string>);
static_assert(!Exchangeable<WithEigenInside>,
              "a struct with Eigen members states that it is copied as bytes");

template <> inline constexpr bool tappet::copied_as_bytes<Stated> = true;
static_assert(Exchangeable<Stated>);

namespace {

template <class T> T through_words(const T& value, T into) {
    Words<T> words;
    words.store(value);
    typename Words<T>::Copy copy;
    words.load(copy);
    Words<T>::unpack(copy, into);
    T directly{};
    words.load(directly);
    EXPECT_EQ(std::memcmp(&directly, &into, sizeof(T)), 0) << "both ways of loading agree";
    return into;
}

TEST(Words, carry_every_byte_of_a_size_that_is_not_a_word_multiple) {
    Odd odd{};
    for (std::size_t i = 0; i < odd.bytes.size(); ++i) odd.bytes[i] = static_cast<std::uint8_t>(200 + i);
    EXPECT_EQ(through_words(odd, Odd{}).bytes, odd.bytes);
    EXPECT_EQ(Words<Odd>::count, 2u);
}

TEST(Words, write_no_byte_after_the_value) {
    struct {
        Odd odd{};
        std::array<std::uint8_t, 3> guard{7, 7, 7};
    } room;
    Words<Odd> words;
    words.store(Odd{});
    Words<Odd>::Copy copy;
    words.load(copy);
    Words<Odd>::unpack(copy, room.odd);
    EXPECT_EQ(room.guard, (std::array<std::uint8_t, 3>{7, 7, 7}));
}

TEST(Words, carry_fixed_size_eigen_types) {
    const Eigen::Matrix<double, 3, 2> value{{1, 2}, {3, 4}, {5, 6}};
    EXPECT_EQ(through_words(value, Eigen::Matrix<double, 3, 2>::Zero().eval()), value);
}

TEST(Words, carry_one_byte) { EXPECT_EQ(through_words(std::uint8_t{0xa5}, std::uint8_t{0}), 0xa5); }

} // namespace
