// A state machine of a constant source, bound by hand, as native code or as tables in memory.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/program/interpreter.hpp"
#include "kernel/script/compiled.hpp"
#include "kernel/script/native.hpp"

#include <array>

namespace tappet::figures {

enum class Form : std::uint8_t {
    compiled, ///< native code, as for a behaviour that is compiled with the firmware
    loaded    ///< tables in memory, as for a script that is loaded at run time
};

/// `source`: a StateMachine, or a ScriptUnit whose first type it is.
template <class Component, const auto& source, Form form> struct Bound {
    static constexpr const ProgramTables& tables = tables_of(source, 0);
    static constexpr std::size_t bytes = std::max<std::size_t>(tables.layout.size, data_alignment);

    Component component{};
    alignas(data_alignment) std::array<std::byte, bytes> data{};
    StateMachineExecution machine{};

    Bound() {
        std::ranges::copy(tables.image, data.begin());
        StateMachineBinding binding;
        binding.machine = native::resolved_type<source, 0>.view();
        binding.component = &component;
        binding.data = data.data();
        if constexpr (form == Form::compiled) {
            if (!tables.programs.empty()) binding.code = native_code<source>;
            binding.fast = native_machine<source>;
        } else if (!tables.programs.empty()) {
            binding.code = interpreted(tables);
        }
        static_cast<void>(machine.bind(binding));
        static_cast<void>(machine.start(at_ns(0)));
    }
    Bound(const Bound&) = delete;
    Bound& operator=(const Bound&) = delete;

    /// The value of a variable of the script.
    template <class T> [[nodiscard]] T variable(std::string_view name) const {
        T value{};
        for (const VariableRow& row : tables.variables)
            if (row.name == name) std::memcpy(&value, data.data() + row.at, sizeof value);
        return value;
    }
};

} // namespace tappet::figures
