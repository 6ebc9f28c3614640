// Parses summaries.
#include "toolchain/tools/front/figures.hpp"

#include <nlohmann/json.hpp>

#include <iomanip>
#include <sstream>

namespace tappet::front {

std::expected<std::string, std::string> figures_of(const std::string& summary) {
    std::ostringstream text;
    try {
        const auto run = nlohmann::json::parse(summary);
        text << run.at("machine").get<std::string>() << " on " << run.at("world").get<std::string>() << ", "
             << run.at("kernel_release").get<std::string>();
        if (!run.at("realtime").get<bool>())
            text << ", not PREEMPT_RT: the responses are those of this host, not of a box";
        text << "\n" << std::left << std::setw(16) << "activity" << std::right;
        for (const char* head :
             {"cycles", "processor us", "claimed us", "response us", "deadline us", "missed"})
            text << std::setw(14) << head;
        text << "\n" << std::fixed << std::setprecision(1);
        for (const auto& each : run.at("activities")) {
            text << std::left << std::setw(16) << each.at("name").get<std::string>() << std::right
                 << std::setw(14) << each.at("cycles").get<std::uint64_t>();
            for (const char* field :
                 {"most_processor_us", "claim_us", "longest_response_us", "deadline_us"}) {
                const double value = each.at(field).get<double>();
                if (value > 0)
                    text << std::setw(14) << value;
                else
                    text << std::setw(14) << "-"; // not real-time, or not measured
            }
            text << std::setw(14) << each.at("deadline_misses").get<std::uint64_t>() << "\n";
        }
    } catch (const nlohmann::json::exception& error) {
        return std::unexpected("the summary cannot be read: " + std::string{error.what()});
    }
    return text.str();
}

} // namespace tappet::front
