// render-report: measures the cost of accuracy in time.
#include "apps/common/command_line.h"
#include "program.h"

int main(int argc, char** argv) {
    using namespace cistula;
    return run_program("render-report", "a smaller --res needs less",
                       [&] { return report::report_program(argc, argv); });
}
