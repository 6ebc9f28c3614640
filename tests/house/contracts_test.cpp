// Logs and manuals refer to the numbers of contracts: each number has one text and a unique name, and the
// product checks it.
#include "kernel/base/contract.hpp"
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace tappet::house {
namespace {

TEST(Contracts, have_unique_numbers_and_names) {
    for (std::size_t a = 0; a < contract_texts.size(); ++a)
        for (std::size_t b = a + 1; b < contract_texts.size(); ++b) {
            EXPECT_NE(contract_texts[a].id, contract_texts[b].id) << contract_texts[a].name;
            EXPECT_NE(contract_texts[a].name, contract_texts[b].name);
        }
}

TEST(Contracts, are_each_checked_by_the_product) {
    for (const ContractText& row : contract_texts) {
        std::string name{row.name}; // the enumerator's, with underscores
        std::ranges::replace(name, '-', '_');
        const bool is_checked = std::ranges::any_of(tree(), [&](const File& file) {
            return file.is_cpp() && !file.is_under("tests") && file.path != "kernel/base/contract.hpp" &&
                   std::ranges::any_of(file.code, [&](const std::string& line) {
                       return find_word(line, name) != std::string::npos;
                   });
        });
        EXPECT_TRUE(is_checked) << "Contract::" << name
                                << " has a number and a text, but nothing checks it: check it, or give it up";
    }
}

} // namespace
} // namespace tappet::house
