// The handling of a broken contract: text, handler, and the default without a handler.
#include "kernel/base/contract.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace tappet {

namespace {

constexpr bool table_is_sound() {
    for (std::size_t i = 0; i < contract_texts.size(); ++i) {
        const ContractText& row = contract_texts[i];
        if (i > 0 && contract_texts[i - 1].id >= row.id) return false;
        if (row.name.empty() || !row.sentence.ends_with('.') ||
            values_of(row.id) > ContractViolation::max_values)
            return false;
        for (std::size_t j = 0; j < i; ++j)
            if (contract_texts[j].name == row.name) return false;
    }
    return true;
}
static_assert(table_is_sound(),
              "ids rise and names differ, so that a log names one contract; sentences end and fit a Breach");

constinit std::atomic<ContractHandler> installed{nullptr};
static_assert(std::atomic<ContractHandler>::is_always_lock_free,
              "contracts are broken on real-time paths too");

// A handler that breaks a contract itself cannot be trusted with a second one, except one after which the
// thread goes on: the way to the safe state may allocate.
constinit thread_local int inside_handler = 0;
constexpr int most_inside = 4;

// Addresses are read by tools that expect hexadecimal.
void add_address(Sentence& text, std::uint64_t address) noexcept {
    char digits[18] = {'0', 'x'};
    std::size_t n = 2;
    for (int shift = 60; shift >= 0; shift -= 4) {
        const auto digit = (address >> shift) & 15u;
        if (digit != 0 || n > 2 || shift == 0) digits[n++] = "0123456789abcdef"[digit];
    }
    text.add(std::string_view{digits, n});
}

[[noreturn]] void last_resort(const ContractViolation& breach) noexcept {
    Sentence text = describe(breach);
    text.add("\n");
    // stderr is unbuffered: this is one write, with no heap behind it.
    std::fwrite(text.characters, 1, text.length, stderr);
    std::abort();
}

} // namespace

Sentence describe(const ContractViolation& breach) noexcept {
    Sentence text{"contract ", static_cast<int>(breach.id), " "};
    const ContractText* row = find_text(breach.id);
    if (row == nullptr) return text.add("is not in the table of this build");
    text.add(row->name).add(": ");
    std::string_view rest = row->sentence;
    for (std::size_t value = 0; !rest.empty(); ++value) {
        const std::size_t hole = std::min(rest.find("{}"), rest.size());
        const bool address = rest.substr(0, hole).ends_with("ddress ");
        text.add(rest.substr(0, hole));
        if (hole == rest.size()) break;
        const std::int64_t number = breach.values[std::min(value, ContractViolation::max_values - 1)];
        if (address)
            add_address(text, static_cast<std::uint64_t>(number));
        else
            text.add(number);
        rest.remove_prefix(hole + 2);
    }
    text.add(" [code at ");
    add_address(text, breach.address);
    return text.add("]");
}

ContractHandler install_contract_handler(ContractHandler handler) noexcept TAPPET_REALTIME {
    return installed.exchange(handler, std::memory_order_acq_rel);
}

void break_contract(const ContractViolation& breach) noexcept TAPPET_REALTIME {
    const ContractHandler handler = installed.load(std::memory_order_acquire);
    const ContractText* row = find_text(breach.id);
    const bool goes_on = row != nullptr && row->after == AfterViolation::thread_goes_on;
    int depth = 0;
    TAPPET_ESCAPE("constant-initialised and in the program's own block of thread storage: never allocated",
                  depth = ++inside_handler);
    if (handler != nullptr && depth <= (goes_on ? most_inside : 1)) {
        handler(breach);
        if (goes_on) {
            TAPPET_ESCAPE("constant-initialised thread storage, as at the entry", --inside_handler);
            return;
        }
    }
    TAPPET_ESCAPE("nothing real-time is left: the process ends here", last_resort(breach));
}

} // namespace tappet
