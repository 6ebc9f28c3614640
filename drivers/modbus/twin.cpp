// The server's answers, correct and faulty.
#include "drivers/modbus/twin.hpp"

namespace tappet::modbus {

void Twin::inject(Fault fault, std::uint32_t requests) noexcept {
    fault_.store(Fault::none, std::memory_order_relaxed);
    strikes_left_.store(requests, std::memory_order_relaxed);
    fault_.store(fault, std::memory_order_release);
}

Fault Twin::strike() noexcept {
    const Fault fault = fault_.load(std::memory_order_acquire);
    const std::uint32_t left = strikes_left_.load(std::memory_order_relaxed);
    if (fault == Fault::none || left == 0) return Fault::none;
    if (left != ~0u) strikes_left_.store(left - 1, std::memory_order_relaxed);
    return fault;
}

Answer Twin::connect() noexcept {
    belongs_to_.used();
    late_answer_ = false;
    connected_ = fault_.load(std::memory_order_acquire) != Fault::down || strike() != Fault::down;
    return {.outcome = connected_ ? Outcome::ok : Outcome::refused, .took = turnaround_};
}

void Twin::disconnect() noexcept {
    connected_ = false;
    late_answer_ = false;
}

bool Twin::recover() noexcept {
    belongs_to_.used();
    disconnect();
    return false;
}

Answer Twin::admit(std::uint16_t address, std::size_t count) noexcept {
    if (!connected_) return {.outcome = Outcome::disconnected};
    if (late_answer_) {
        late_answer_ = false;
        return {.outcome = Outcome::garbled, .took = turnaround_};
    }
    Answer answer{.took = turnaround_};
    switch (strike()) {
    case Fault::none: break;
    case Fault::silent: return {.outcome = Outcome::timeout, .took = answer_within_};
    case Fault::slow:
        answer.took += Duration{slow_by_ns_.load(std::memory_order_relaxed)};
        if (answer.took > answer_within_) {
            late_answer_ = true;
            return {.outcome = Outcome::timeout, .took = answer_within_};
        }
        break;
    case Fault::exception:
        return {.outcome = Outcome::exception,
                .exception = exception_.load(std::memory_order_relaxed),
                .took = turnaround_};
    case Fault::wrong_transaction:
    case Fault::garbage_length: return {.outcome = Outcome::garbled, .took = turnaround_};
    case Fault::down: disconnect(); return {.outcome = Outcome::disconnected, .took = turnaround_};
    }
    constexpr std::uint8_t illegal_data_address = 2;
    if (address + count > size)
        return {.outcome = Outcome::exception, .exception = illegal_data_address, .took = answer.took};
    return answer;
}

Answer Twin::read(Table table, std::uint16_t address, std::span<std::uint16_t> values) noexcept {
    belongs_to_.used();
    const Answer answer = admit(address, values.size());
    if (answer.outcome != Outcome::ok) return answer;
    const auto all = whole();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint16_t word = get(table, address + i);
        values[i] = holds_bits(table) && word != 0 ? std::uint16_t{1} : word;
    }
    return answer;
}

Answer Twin::write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) noexcept {
    belongs_to_.used();
    constexpr std::uint8_t illegal_function = 1;
    if (!writable(table))
        return {.outcome = Outcome::exception, .exception = illegal_function, .took = turnaround_};
    const Answer answer = admit(address, values.size());
    if (answer.outcome != Outcome::ok) return answer;
    const auto all = whole();
    constexpr std::uint8_t illegal_data_value = 3;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!accepts(table, address + i, values[i]))
            return {.outcome = Outcome::exception, .exception = illegal_data_value, .took = answer.took};
    for (std::size_t i = 0; i < values.size(); ++i) set(table, address + i, values[i]);
    return answer;
}

} // namespace tappet::modbus
