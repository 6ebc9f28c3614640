// Each component's properties in a file of their own, in one directory (thesis 4.7.1): read during
// configuration, replaced as a whole when saved.
#pragma once

#include "kernel/machine/instance/property_store.hpp"
#include "kernel/services/configuration/cpf.hpp"

#include <array>
#include <expected>

namespace tappet {

/// Large: place it in static memory. One thread at a time, not real-time. Reading allocates from the heap,
/// writing does not.
class PropertyFiles {
public:
    static constexpr std::size_t longest_path = 512;

    /// `directory` must outlive it. With an empty one nothing is kept: optional files are missing, others are
    /// an error.
    explicit PropertyFiles(std::string_view directory) noexcept : directory_{directory} {}

    /// Sets another directory, which must outlive it too.
    void keep_in(std::string_view directory) noexcept { directory_ = directory; }
    /// Reads also the files in `older`, which must outlive it. They were written later, by a machine whose
    /// properties may differ: they override those of the directory, as far as they fit; `left_out` receives
    /// the rest. Files are saved only to the directory, so that nothing in `older` is lost.
    void take_over(std::string_view older, LeftOut left_out) noexcept {
        older_ = older;
        left_out_ = left_out;
    }
    /// Returns the store for MachineInstance::read_properties_from.
    [[nodiscard]] PropertyStore store() noexcept;

    [[nodiscard]] Sentence load(const ComponentRow& row, PropertyTransaction& into) noexcept;
    [[nodiscard]] Sentence save(const ComponentRow& row, const PropertyTransaction& from) noexcept;

    [[nodiscard]] bool keeps() const noexcept { return !directory_.empty(); }

private:
    [[nodiscard]] bool name_path(std::string_view directory, std::string_view file) noexcept;
    /// Returns whether there is a file.
    [[nodiscard]] std::expected<bool, Sentence> load_from(std::string_view directory, const ComponentRow& row,
                                                          LeftOut left_out,
                                                          PropertyTransaction& into) noexcept;

    std::string_view directory_;
    std::string_view older_{};
    LeftOut left_out_ = nullptr;
    CpfListForms forms_{}; ///< of the lists that were read
    std::array<char, longest_path + 1> path_{};
    std::array<char, max_cpf_bytes> text_{};
};

} // namespace tappet
