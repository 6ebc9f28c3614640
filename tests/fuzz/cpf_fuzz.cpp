// Any bytes as a properties file (thesis 4.7.1): the reader refuses with a sentence, or accepts values that
// it then writes and reads back unchanged; it never reads outside its text and always ends.
#include "kernel/services/configuration/cpf.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/kernel/component/every_property.hpp"

#include <array>

namespace {

using namespace tappet;
using tappet::fuzz::demand;

std::array<char, 2 * max_cpf_bytes> written; // the values of a file may be longer in our spelling

CpfListForms forms; // of the text's lists

std::size_t write(every::Arm& arm, std::span<char> into) {
    static PropertyTransaction all;
    all.begin("arm", component_type<every::Arm>, &arm);
    all.change_all();
    all.capture();
    Sentence fault;
    const std::size_t length = write_cpf(all, into, fault, {forms.begin(), forms.size()});
    demand(length != 0 && fault.empty());
    return length;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static PropertyTransaction transaction;
    every::Arm arm;
    forms.clear();
    transaction.begin("arm", component_type<every::Arm>, &arm);
    const Sentence fault =
        read_cpf({reinterpret_cast<const char*>(data), size}, "fuzz.cpf", transaction, nullptr, &forms);
    if (!fault.empty()) {
        demand(fault.view().starts_with("fuzz.cpf:"));
        return 0;
    }
    transaction.commit();
    const std::size_t length = write(arm, written);
    every::Arm again;
    transaction.begin("arm", component_type<every::Arm>, &again);
    demand(read_cpf({written.data(), length}, "again.cpf", transaction).empty());
    transaction.commit();
    demand(every::same_properties(arm, again));
    return 0;
}
