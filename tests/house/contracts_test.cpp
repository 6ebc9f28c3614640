// The numbers of contracts are written in logs and manuals: each stands once, with one text, and its name is
// unique.
#include "kernel/base/contract.hpp"

#include <gtest/gtest.h>

namespace tappet::house {
namespace {

TEST(Contracts, have_unique_numbers_and_names) {
    for (std::size_t a = 0; a < contract_texts.size(); ++a)
        for (std::size_t b = a + 1; b < contract_texts.size(); ++b) {
            EXPECT_NE(contract_texts[a].id, contract_texts[b].id) << contract_texts[a].name;
            EXPECT_NE(contract_texts[a].name, contract_texts[b].name);
        }
}

} // namespace
} // namespace tappet::house
