// Reads attributes of a DBC file: rates, CAN FD, and names of more than 32 characters.
#pragma once

#include "drivers/can/dbc/choice.hpp"
#include "drivers/can/dbc/statement_reader.hpp"
#include "kernel/base/decimal.hpp"

namespace tappet::can::dbc {

class AttributeReader : protected StatementReader {
protected:
    using StatementReader::StatementReader;

    Choice* choice(std::string_view attribute) noexcept {
        for (Choice* const each : {&fd_, &switch_, &demand_})
            if (each->attribute == attribute) return each;
        return nullptr;
    }
    /// Returns the value of the attribute; it is unknown after a fault.
    Says chosen(Choice& among) {
        const std::size_t at = in_.at();
        Says says = Says::unknown;
        if (in_.next() == '"') {
            says = among.says(text("the attribute's value"));
        } else {
            const std::uint32_t number = whole(0xffff'ffff, "the number of the attribute's value");
            says = among.of(number);
            among.is_used = true;
        }
        if (says == Says::unknown && ok()) fail(at, among.attribute, " has no such value");
        return says;
    }
    /// An attribute's name. Its meaning must not be lost with one of its characters.
    std::string_view attribute_name() {
        const std::size_t at = in_.at();
        const std::string_view name = text("an attribute's name between quotes");
        for (const std::string_view each : {period, fd_.attribute, switch_.attribute, demand_.attribute})
            if (ok() && is_nearly(name, each))
                give_up(at, "attribute \"", name, "\" is unknown; did you mean \"", each, "\"?");
        return name;
    }
    void attribute_definition() {
        constexpr std::string_view objects = "BO_ BU_ SG_ EV_", types = "INT HEX FLOAT STRING ENUM";
        const bool is_of_messages = in_.peek() == "BO_";
        if (names(objects, in_.peek())) in_.word();
        const std::string_view name = attribute_name();
        if (!ok()) return;
        if (!names(types, in_.peek())) return fail_expected("a type: INT, HEX, FLOAT, STRING or ENUM");
        Choice* const of = is_of_messages ? choice(name) : nullptr;
        if (of == nullptr) return skip_statement();
        if (of->is_defined || of->is_used)
            return give_up(statement_at_, name, " is defined twice, or behind its use");
        of->is_defined = true;
        if (in_.peek() != "ENUM") return skip_statement();
        in_.word();
        of->yes = of->unknown = of->count = 0;
        do {
            const std::string_view value = text("a value's name between quotes");
            if (ok() && !of->define(value)) give_up(in_.at(), name, " has more than 64 values");
        } while (ok() && in_.take(','));
        end_of_statement();
    }

    Duration cycle_time() {
        const std::size_t at = in_.at();
        const double ms = real("the cycle time in milliseconds");
        if (ok() && !(ms >= 0 && ms < 1e9)) fail(at, "a cycle time of ", decimal(ms), " ms");
        return ok() ? Duration{static_cast<std::int64_t>(ms * 1e6 + 0.5)} : Duration{};
    }
    void attribute() {
        const std::string_view name = attribute_name();
        if (!ok()) return;
        const std::string_view of = in_.peek();
        const bool is_message_name = name == "SystemMessageLongSymbol" && of == "BO_";
        const bool is_signal_name = name == "SystemSignalLongSymbol" && of == "SG_";
        Choice* const among = choice(name);
        if (among == nullptr && name != period && !is_message_name && !is_signal_name)
            return skip_statement();
        if (!is_signal_name && of != "BO_") return fail_expected("BO_, because the attribute is of messages");
        in_.word();
        if (!known_message(true) || (is_signal_name && !known_signal())) return;
        if (among != nullptr) return choose(*among);
        if (name == period) return state_period();
        const std::string_view long_name = text("a name between quotes");
        end_of_statement();
        if (!ok()) return;
        if (is_signal_name)
            for_each_namesake([&](SignalRow& each) { each.long_name = long_name; });
        else
            the_message().long_name = long_name;
    }
    void choose(Choice& among) {
        part_ = &among == &demand_ ? Part::rate : Part::format;
        const std::size_t at = in_.at();
        const Says says = chosen(among);
        end_of_statement();
        if (!ok()) return;
        bool is_twice = false;
        for_each_twin([&](MessageRow& each) {
            std::optional<bool>& stated = &among == &fd_       ? each.is_fd
                                          : &among == &switch_ ? each.switches
                                                               : each.on_demand;
            is_twice |= stated.has_value() && *stated != (says == Says::yes);
            stated = says == Says::yes;
        });
        if (is_twice) spoil(at, among.attribute, " is there twice");
    }
    void state_period() {
        part_ = Part::rate;
        const std::size_t at = in_.at();
        const Duration every = cycle_time();
        end_of_statement();
        if (!ok()) return;
        bool is_twice = false;
        for_each_twin([&](MessageRow& each) {
            is_twice |= each.says_every && each.every != every;
            each.says_every = true;
            each.every = every;
        });
        if (is_twice) spoil(at, period, " is there twice");
    }
    void attribute_default() {
        const std::size_t at = in_.at();
        const std::string_view name = attribute_name();
        if (!ok()) return;
        Choice* const of = choice(name);
        if (of == nullptr && name != period) return skip_statement();
        bool& is_stated = of == &fd_       ? has_default_[0]
                          : of == &switch_ ? has_default_[1]
                          : of == &demand_ ? has_default_[2]
                                           : has_default_[3];
        if (is_stated) return give_up(at, name, " has two defaults");
        is_stated = true;
        const Says says = of != nullptr ? chosen(*of) : Says::no;
        const Duration every = of == nullptr ? cycle_time() : Duration{};
        end_of_statement();
        if (!ok()) return;
        if (of != nullptr)
            of->usually = says == Says::yes;
        else
            usual_every_ = every;
    }

    void take_defaults(MessageRow& message) {
        if (!message.says_every) message.every = usual_every_;
        if (!message.is_fd) message.is_fd = fd_.usually;
        if (!message.switches) message.switches = switch_.usually;
        if (!message.on_demand) message.on_demand = demand_.usually;
    }

    static constexpr std::string_view period = "GenMsgCycleTime";

    bool has_default_[4] = {}; ///< of the three choices and the cycle time
    Duration usual_every_{};
    Choice fd_ = can_fd, switch_ = bit_rate_switch, demand_ = send_type;
};

} // namespace tappet::can::dbc
