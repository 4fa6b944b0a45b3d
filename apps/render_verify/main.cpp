// render-verify: the hard cases, against closed forms, on every intersector.
#include "apps/common/command_line.h"
#include "apps/render_verify/program.h"

int main(int argc, char** argv) {
    using namespace cistula;
    return run_program("render-verify", "--quick and fewer cases need less",
                       [&] { return verify::verify_program(argc, argv); });
}
