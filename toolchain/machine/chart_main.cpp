// main of every machine's charts: its accepted table, and the model for spin from its own header.
#ifdef TAPPET_MODEL_HEADER
#include TAPPET_MODEL_HEADER
#endif

#include "toolchain/machine/on_host.hpp"
#include "toolchain/tools/chart/program.hpp"

int main(int count, char** words) {
#ifdef TAPPET_MODEL_HEADER
    return tappet::chart::run_chart(TAPPET_NAMESPACE::on_host(), TAPPET_NAMESPACE::model, count, words);
#else
    return tappet::chart::run_chart(TAPPET_NAMESPACE::on_host(), {}, count, words);
#endif
}
