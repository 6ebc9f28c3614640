// Broken contracts: faults of the program, never of the plant. Each has a number that stays, a sentence and
// its values, and leads to the installed handler, which stops the machine safely. Operating errors are
// values, not contracts.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace tappet {

/// The numbers are written in logs and manuals: they are never reused and never changed.
enum class Contract : std::uint16_t {
    index_out_of_range = 1,
    precondition = 2,
    unreachable_code = 3,
    ring_storage_too_small = 101,
    ring_overflow = 102,
    single_writer = 103,
    single_reader = 104,
    command_sender = 105,
    timer_unserved = 106,
    allocation_after_seal = 201,
    mapping_after_seal = 202,
    heap_exhausted = 203,
    heap_foreign_pointer = 204,
    heap_double_free = 205,
    heap_damaged = 206,
    heap_lock_failed = 207,
    memory_not_there = 208,
    time_went_backwards = 301,
    step_limit_exceeded = 401,
    state_unknown = 402,
};

/// What follows once the handler returned. A thread that stops must not be let go on: its next step would use
/// what the contract says does not hold.
enum class AfterBreach : std::uint8_t { thread_stops, thread_goes_on };

struct ContractText {
    Contract id;
    std::string_view name;
    std::string_view sentence; ///< one {} for each value, in order
    AfterBreach after = AfterBreach::thread_stops;
};

// clang-format off
inline constexpr auto contract_texts = std::to_array<ContractText>({
    {Contract::index_out_of_range,     "index-out-of-range",     "Element {} was asked of something that has {}."},
    {Contract::precondition,           "precondition",           "A function was called with {}, which its declaration forbids."},
    {Contract::unreachable_code,       "unreachable-code",       "A case that no table contains was reached with {}."},
    {Contract::ring_storage_too_small, "ring-storage-too-small", "A ring of {} elements got storage for {}."},
    {Contract::ring_overflow,          "ring-overflow",          "A ring sized for {} elements was given one more: a rate in the table is too low."},
    {Contract::single_writer,          "single-writer",          "Two threads wrote what has one writer; the second is thread {}."},
    {Contract::single_reader,          "single-reader",          "Two threads read what has one reader; the second is thread {}."},
    {Contract::command_sender,         "command-sender",         "A command that activity {} sends was sent in activity {}: write sent_by(...) in its row."},
    {Contract::timer_unserved,         "timer-unserved",         "A timer that no engine serves was armed for {} ns in activity {}: name it by timer<...>(...) in its component's interface."},
    {Contract::allocation_after_seal,  "allocation-after-seal",  "{} bytes were allocated after arming by the code at address {}.", AfterBreach::thread_goes_on},
    {Contract::mapping_after_seal,     "mapping-after-seal",     "{} bytes of address space were asked for after arming by the code at address {}; refused.", AfterBreach::thread_goes_on},
    {Contract::heap_exhausted,         "heap-exhausted",         "{} bytes were asked of the arena, {} are free in it, {} in one piece: give TAPPET_HEAP_ARENA more.", AfterBreach::thread_goes_on},
    {Contract::heap_foreign_pointer,   "heap-foreign-pointer",   "Address {} was freed but never allocated."},
    {Contract::heap_double_free,       "heap-double-free",       "Address {} was freed twice."},
    {Contract::heap_damaged,           "heap-damaged",           "Memory before address {} was overwritten."},
    {Contract::heap_lock_failed,       "heap-lock-failed",       "The heap's lock was refused with error {}: malloc inside a signal handler, or a kernel without PI futexes."},
    {Contract::memory_not_there,       "memory-not-there",       "{} bytes were not there for the code at address {}, which cannot go on without."},
    {Contract::time_went_backwards,    "time-went-backwards",    "The time went from {} ns back to {} ns."},
    {Contract::step_limit_exceeded,    "step-limit-exceeded",    "A bounded procedure of {} steps asked for step {}."},
    {Contract::state_unknown,          "state-unknown",          "State {} was entered in a machine of {} states."},
});
// clang-format on

constexpr const ContractText* find_text(Contract id) noexcept TAPPET_REALTIME {
    for (const ContractText& row : contract_texts)
        if (row.id == id) return &row;
    return nullptr;
}

constexpr std::size_t values_of(Contract id) noexcept TAPPET_REALTIME {
    std::size_t count = 0;
    if (const ContractText* row = find_text(id))
        for (std::size_t i = 0; i + 1 < row->sentence.size(); ++i)
            if (row->sentence[i] == '{' && row->sentence[i + 1] == '}') ++count;
    return count;
}

/// What a handler gets.
struct Breach {
    static constexpr std::size_t max_values = 4;
    Contract id{};
    std::array<std::int64_t, max_values> values{};
    std::uint64_t address = 0; ///< the code that noticed; addr2line names it
};

/// The sentence with its values: "contract 101 ring-storage-too-small: A ring of 8 elements got storage
/// for 4. [code at 0x...]".
Sentence describe(const Breach& breach) noexcept;

/// Leads to the safe state. Called on the thread that broke the contract, possibly on several at once. For a
/// contract after which the thread stops it does not return: when it does, the process is aborted. Real-time.
using ContractHandler = void (*)(const Breach&) noexcept TAPPET_REALTIME;

/// Returns the handler that was there; nullptr, as at the start, stands for: print on standard error and
/// abort. Real-time.
ContractHandler install_contract_handler(ContractHandler handler) noexcept TAPPET_REALTIME;

/// Calls the handler. It returns only from contracts after which the thread goes on. Real-time until it
/// aborts.
void break_contract(const Breach& breach) noexcept TAPPET_REALTIME;

template <class T>
concept ContractValue = std::integral<T> || std::is_enum_v<T> || std::is_pointer_v<T> ||
                        requires(T t) { std::chrono::nanoseconds{t}.count(); };

template <ContractValue T> std::int64_t contract_value(const T& value) noexcept TAPPET_REALTIME {
    if constexpr (std::is_pointer_v<T>)
        return static_cast<std::int64_t>(reinterpret_cast<std::uintptr_t>(value));
    else if constexpr (std::integral<T> || std::is_enum_v<T>)
        return static_cast<std::int64_t>(value);
    else
        return std::chrono::nanoseconds{value}.count();
}

/// What TAPPET_CONTRACT calls. Not constexpr on purpose: a broken contract in a constant expression does not
/// compile.
template <Contract id, ContractValue... Values>
[[gnu::cold, gnu::noinline]] void contract_broken(const Values&... values) noexcept TAPPET_REALTIME {
    static_assert(find_text(id) != nullptr, "a contract has a row in contract_texts");
    static_assert(sizeof...(Values) == values_of(id),
                  "a contract gets one value for each {} of its sentence");
    const auto address = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
    break_contract(Breach{id, {contract_value(values)...}, address});
}

} // namespace tappet

///     TAPPET_CONTRACT(slots.size() >= depth, Contract::ring_storage_too_small, depth, slots.size());
#define TAPPET_CONTRACT(condition, id, ...)                                                                  \
    do {                                                                                                     \
        if (!(condition)) [[unlikely]]                                                                       \
            ::tappet::contract_broken<id>(__VA_ARGS__);                                                      \
    } while (false)
