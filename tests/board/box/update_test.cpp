// The box accepts a signed update exactly as it was made: any changed byte is refused.
#include "board/box/update.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::box {
namespace {

using testing::HasSubstr;

struct Updates : testing::Test {
    KeyPair keys = new_keys();
    Update update{{"carpet-loom", "ipc-x86_64", "a5", 7, 3}, "a kernel, and more of it", ""};
    std::string bytes = encode(update, keys.secret);
};

TEST_F(Updates, are_read_as_they_were_made) {
    const auto read = decode(bytes, keys.open);
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(read->manifest.machine, "carpet-loom");
    EXPECT_EQ(read->manifest.board, "ipc-x86_64");
    EXPECT_EQ(read->manifest.version, 7u);
    EXPECT_EQ(read->manifest.least, 3u);
    EXPECT_EQ(read->manifest.layout, "a5");
    EXPECT_EQ(read->kernel, update.kernel);
    EXPECT_EQ(read->header + read->kernel, bytes);
    EXPECT_EQ(claimed_bytes(bytes), bytes.size());
}

TEST_F(Updates, are_refused_when_any_byte_is_changed) {
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] ^ 1);
        ASSERT_FALSE(decode(changed, keys.open)) << "byte " << at;
    }
}

TEST_F(Updates, have_headers_that_are_trusted_only_with_a_valid_signature) {
    const std::string header = bytes.substr(0, update_header_bytes);
    EXPECT_TRUE(has_signed_header(header, keys.open));
    EXPECT_FALSE(has_signed_header(header, new_keys().open));
    EXPECT_FALSE(has_signed_header(header_of(update, nullptr), keys.open));
    EXPECT_FALSE(has_signed_header("anything", keys.open));
    // The second signature follows the lines and is checked with the kernel.
    for (std::size_t at = 0; at < update_header_bytes - 64; ++at) {
        std::string changed = header;
        changed[at] = static_cast<char>(changed[at] ^ 1);
        ASSERT_FALSE(has_signed_header(changed, keys.open)) << "byte " << at;
    }
}

TEST_F(Updates, are_refused_when_truncated_or_signed_by_another_key) {
    EXPECT_THAT(decode(bytes, new_keys().open).error(), HasSubstr("does not match this box's key"));
    EXPECT_THAT(decode(std::string_view{bytes}.substr(0, bytes.size() - 1), keys.open).error(),
                HasSubstr("it is incomplete"));
    EXPECT_THAT(decode("anything", keys.open).error(), HasSubstr("it is not an update"));
    EXPECT_EQ(claimed_bytes(std::string(update_header_bytes, 'x')), 0u);
}

TEST_F(Updates, never_claim_more_bytes_than_a_slot_holds) {
    for (const char* number : {"50331648", "18446744073709551615", "18446744073709547520", "-1", "1e9"}) {
        std::string header = header_of(update, nullptr);
        const std::string line = "kernel " + std::to_string(update.kernel.size());
        header.replace(header.find(line), line.size(), std::string{"kernel "} + number);
        header.resize(update_header_bytes);
        EXPECT_GE(claimed_bytes(header), update_header_bytes) << number;
        EXPECT_LE(claimed_bytes(header), most_update_bytes + update_header_bytes) << number;
    }
}

TEST_F(Updates, are_accepted_only_when_newer_and_meant_for_this_box) {
    const Manifest own{"carpet-loom", "ipc-x86_64", "a5", 6, 0};
    EXPECT_EQ(refusal_of(update.manifest, own), "");
    EXPECT_THAT(refusal_of({"carpet-loom", "bench", "a5", 7, 3}, own),
                HasSubstr("it is for carpet-loom on board bench"));
    EXPECT_THAT(refusal_of({"press", "ipc-x86_64", "a5", 7, 3}, own), HasSubstr("it is for press"));
    EXPECT_THAT(refusal_of({"carpet-loom", "ipc-x86_64", "a5", 6, 3}, own),
                HasSubstr("it is version 6, and this box has 6"));
    EXPECT_THAT(refusal_of({"carpet-loom", "ipc-x86_64", "a5", 5, 3}, own), HasSubstr("it is version 5"));
    EXPECT_THAT(refusal_of({"carpet-loom", "ipc-x86_64", "a5", 9, 7}, own),
                HasSubstr("it wants version 7 before it"));
}

TEST_F(Updates, are_readable_but_refused_without_a_signature) {
    const std::string header = header_of(update, nullptr);
    EXPECT_EQ(manifest_of(header).version, 7u);
    EXPECT_TRUE(is_of(header, update.kernel));
    EXPECT_FALSE(is_of(header, update.kernel + "x"));
    EXPECT_TRUE(is_of("", update.kernel)) << "it says nothing";
    EXPECT_FALSE(decode(header + update.kernel, keys.open));
    EXPECT_EQ(manifest_of("anything").version, 0u);
}

TEST(Orders, are_valid_for_one_box_and_one_boot) {
    const KeyPair keys = new_keys();
    const Order order{"roll-back", "carpet-loom", "ipc-x86_64", "0123"};
    const std::string signature = sign(order, keys.secret);
    EXPECT_TRUE(is_signed(order, signature, keys.open));
    EXPECT_FALSE(is_signed(order, signature, new_keys().open));
    EXPECT_FALSE(is_signed(order, signature.substr(2), keys.open));
    EXPECT_FALSE(is_signed(order, "", keys.open));
    for (const Order& other : {Order{"factory-reset", "carpet-loom", "ipc-x86_64", "0123"},
                               Order{"roll-back", "press", "ipc-x86_64", "0123"},
                               Order{"roll-back", "carpet-loom", "bench", "0123"},
                               Order{"roll-back", "carpet-loom", "ipc-x86_64", "0124"}})
        EXPECT_FALSE(is_signed(other, signature, keys.open)) << other.verb << other.machine << other.nonce;
}

TEST(Keys, are_written_in_64_digits) {
    const KeyPair keys = new_keys();
    EXPECT_EQ(key_of(digits_of(keys.open)).value(), keys.open);
    EXPECT_FALSE(key_of(""));
    EXPECT_FALSE(key_of(digits_of(keys.open).substr(1)));
    EXPECT_FALSE(key_of(std::string(64, 'g')));
}

} // namespace
} // namespace tappet::box
