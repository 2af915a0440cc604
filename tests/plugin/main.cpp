#include "renderer/app/program.h"

int main(int argc, char** argv) { return rapport::run_program(argc, argv); }
