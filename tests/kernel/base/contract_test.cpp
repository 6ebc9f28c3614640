// Contracts: permanent numbers, reported values, called handlers.
#include "kernel/base/contract.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tappet {
namespace {

thread_local ContractViolation last{};
thread_local int calls = 0;

void remember(const ContractViolation& breach) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("a test looks at it", last = breach; ++calls);
}

void breaks_another(const ContractViolation&) noexcept TAPPET_REALTIME {
    TAPPET_CONTRACT(false, Contract::allocation_after_seal, 7, 8);
}

struct Handler {
    explicit Handler(ContractHandler handler) : before{install_contract_handler(handler)} { calls = 0; }
    ~Handler() { install_contract_handler(before); }
    Handler(const Handler&) = delete;
    Handler& operator=(const Handler&) = delete;
    ContractHandler before;
};

constexpr int checked_half(int n) noexcept TAPPET_REALTIME {
    TAPPET_CONTRACT(n % 2 == 0, Contract::precondition, n);
    return n / 2;
}

template <int n>
concept half_is_constant = requires { typename std::integral_constant<int, checked_half(n)>; };

TEST(Contract, has_an_id_that_never_changes) {
    using enum Contract;
    constexpr std::pair<Contract, int> numbers[] = {{index_out_of_range, 1},     {precondition, 2},
                                                    {single_writer, 103},        {single_reader, 104},
                                                    {command_sender, 105},       {timer_unserved, 106},
                                                    {engine_runs, 107},          {wrong_phase, 108},
                                                    {one_activity, 109},         {allocation_after_seal, 201},
                                                    {mapping_after_seal, 202},   {heap_exhausted, 203},
                                                    {heap_foreign_pointer, 204}, {heap_double_free, 205},
                                                    {heap_damaged, 206},         {heap_lock_failed, 207},
                                                    {memory_not_there, 208},     {step_limit_exceeded, 401},
                                                    {not_a_number, 4},           {refused_settings, 5}};
    for (const auto& [contract, number] : numbers) EXPECT_EQ(static_cast<int>(contract), number);
    for (const int given_up : {3, 101, 102, 301, 402})
        EXPECT_EQ(find_text(static_cast<Contract>(given_up)), nullptr) << given_up << " had another meaning";
    EXPECT_EQ(contract_texts.size(), std::size(numbers)) << "a new contract gets its number here";
}

/// Allocates, as the way to the safe state may; that is another breach.
void allocates(const ContractViolation& breach) noexcept TAPPET_REALTIME {
    remember(breach);
    if (breach.id == Contract::precondition) TAPPET_CONTRACT(false, Contract::allocation_after_seal, 1, 2);
    if (breach.id == Contract::precondition)
        TAPPET_ESCAPE("what the handler does at its end", std::_Exit(calls));
}

TEST(ContractDeathTest, reports_a_breach_inside_the_handler_of_another_breach) {
    EXPECT_EXIT(
        {
            const Handler handler{allocates};
            TAPPET_CONTRACT(false, Contract::precondition, 7);
        },
        testing::ExitedWithCode(2), "");
}

TEST(Contract, holds_in_a_constant_expression_or_does_not_compile) {
    static_assert(half_is_constant<4>);
    static_assert(!half_is_constant<5>);
}

TEST(Contract, gives_the_handler_its_id_values_and_place) {
    const Handler handler{remember};
    const int somewhere = 0;
    TAPPET_CONTRACT(1 + 1 == 2, Contract::allocation_after_seal, 1, 2);
    EXPECT_EQ(calls, 0);
    TAPPET_CONTRACT(1 + 1 == 3, Contract::allocation_after_seal, std::size_t{48}, &somewhere);
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(last.id, Contract::allocation_after_seal);
    EXPECT_EQ(last.values[0], 48);
    EXPECT_EQ(last.values[1], static_cast<std::int64_t>(reinterpret_cast<std::uintptr_t>(&somewhere)));
    EXPECT_NE(last.address, 0u);
}

TEST(Contract, is_described_with_every_value) {
    const ContractViolation breach{Contract::index_out_of_range, {8, -4}, 0xbeef};
    EXPECT_EQ(
        describe(breach).view(),
        "contract 1 index-out-of-range: Element 8 was accessed, but there are only -4. [code at 0xbeef]");
    EXPECT_EQ(describe({Contract::heap_double_free, {0x10}, 0}).view(),
              "contract 205 heap-double-free: Address 0x10 was freed twice. [code at 0x0]");
    EXPECT_EQ(describe({static_cast<Contract>(9999), {}, 0}).view(),
              "contract 9999 is not in the table of this build");
}

TEST(Contract, describes_every_breach_with_a_complete_sentence) {
    for (const ContractText& row : contract_texts) {
        const ContractViolation breach{row.id, {11, 22, 33, 44}, 1};
        EXPECT_EQ(describe(breach).view().find('{'), std::string_view::npos) << row.name;
        EXPECT_LT(describe(breach).length, Sentence::capacity) << row.name;
    }
}

TEST(Contract, takes_durations_and_enumerations_as_values) {
    EXPECT_EQ(contract_value(std::chrono::milliseconds{3}), 3'000'000);
    EXPECT_EQ(contract_value(Contract::precondition), 2);
}

TEST(Contract, is_reported_again_after_the_thread_continued) {
    const Handler handler{remember};
    for (int n = 0; n < 3; ++n) TAPPET_CONTRACT(n < 0, Contract::mapping_after_seal, n, 0);
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(last.values[0], 2);
}

TEST(Contract, is_handled_on_the_thread_that_broke_it) {
    const Handler handler{remember};
    int seen = 0;
    std::thread other{[&] {
        TAPPET_CONTRACT(seen != 0, Contract::allocation_after_seal, 1, 2);
        seen = calls;
    }};
    other.join();
    EXPECT_EQ(seen, 1);
    EXPECT_EQ(calls, 0);
}

using ContractDeathTest = ::testing::Test;

TEST(ContractDeathTest, prints_and_aborts_without_a_handler) {
    EXPECT_DEATH(TAPPET_CONTRACT(false, Contract::index_out_of_range, 9, 4),
                 "contract 1 index-out-of-range: Element 9 was accessed, but there are only 4");
}

TEST(ContractDeathTest, aborts_when_the_handler_resumes_a_stopped_thread) {
    const Handler handler{remember};
    EXPECT_DEATH(TAPPET_CONTRACT(false, Contract::index_out_of_range, 9, 4), "contract 1 ");
}

TEST(ContractDeathTest, aborts_when_the_handler_breaks_a_contract_itself) {
    const Handler handler{breaks_another};
    EXPECT_DEATH(TAPPET_CONTRACT(false, Contract::mapping_after_seal, 1, 2), "contract 201 .* 7 bytes");
}

} // namespace
} // namespace tappet
