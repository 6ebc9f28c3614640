// A component's properties before it is configured: its defaults, what its row sets and what its file says,
// as one transaction that the component consents to or refuses.
#include "kernel/machine/instance/instance.hpp"

namespace tappet {

Sentence MachineInstance::configure_properties(std::size_t c) {
    const ComponentRow& row = machine_.table.components[c];
    PropertyTransaction transaction;
    transaction.begin(row.name, *row.type, component(c));
    for (const PropertyRow& setting : row.settings) {
        const std::size_t index = find_facet(row, setting.name);
        row.type->facets[index].property->set(transaction.change(index), setting.setting);
    }
    if (row.has_properties_file) {
        if (store_.load == nullptr)
            return Sentence{"component \"", row.name, "\" has the properties file \"", row.properties.name,
                            "\" but this start-up reads none; give it read_properties_from(...)"};
        if (Sentence fault = store_.load(store_.self, row, transaction); !fault.empty()) return fault;
    }
    transaction.commit();
    if (transaction.refusal().empty()) return {};
    Sentence text{"component \"", row.name, "\" refuses its properties"};
    if (row.has_properties_file) text.add(" (see \"").add(row.properties.name).add("\")");
    return text.add(": ").add(transaction.refusal());
}

Sentence MachineInstance::save_properties() {
    Sentence first;
    for (std::size_t c = 0; c < machine_.table.components.size(); ++c) {
        const ComponentRow& row = machine_.table.components[c];
        if (!row.has_properties_file || store_.save == nullptr) continue;
        PropertyTransaction all;
        all.begin(row.name, *row.type, component(c));
        all.change_all();
        all.capture();
        const Sentence fault = store_.save(store_.self, row, all);
        if (first.empty()) first = fault;
    }
    return first;
}

} // namespace tappet
