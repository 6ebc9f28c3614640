// Writes the source of a machine of any size: the costs of compiling, holding and running it are figures.
#pragma once

#include <cstddef>
#include <iosfwd>

namespace tappet::figures {

struct MachineSize {
    std::size_t components = 10;

    /// The largest number of different component types: real machines consist of many of the same.
    [[nodiscard]] std::size_t types() const;
    /// Ten components each, until there are as many activities as a table may have.
    [[nodiscard]] std::size_t activities() const;
    /// Each component has four inputs.
    [[nodiscard]] std::size_t connections() const { return 4 * components; }
    /// The event of every second component has a reaction in another one.
    [[nodiscard]] std::size_t reactions() const { return components / 2; }
};

/// One translation unit that defines `tappet::AcceptedMachine tappet::figures::accepted()`.
void write_machine(std::ostream& out, const MachineSize& size);

} // namespace tappet::figures
