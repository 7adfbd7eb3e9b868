# Joins one page's HTML, the styles and the bundle, cut in two where the data go, and writes a C++ source whose
# assembler includes both parts byte by byte.
# Called with -DSOURCE=<this folder> -DBUILD=<its build folder, with node_modules and the bundle> and
# -DPAGE=<calibration|accuracy|servo|intrinsics|legs> -DFUNCTION=<the function of page_template.h to define>
# -DPACKAGES=<the npm packages in the bundle, separated by commas>.

set(room ${SOURCE}/src/${PAGE})
file(READ ${room}/${PAGE}.html page)
file(READ ${SOURCE}/src/shared/styles.css shared_style)
file(READ ${room}/styles.css own_style)
file(READ ${BUILD}/${PAGE}.js script)

# The licences of what is bundled ask to be passed on.
set(licences "")
string(REPLACE "," ";" packages "${PACKAGES}")
foreach(package ${packages})
  file(GLOB licence_file ${BUILD}/node_modules/${package}/LICENSE*)
  file(READ ${licence_file} licence)
  string(APPEND licences "${package}\n\n${licence}\n")
endforeach()

string(REPLACE "@STYLE@" "${shared_style}\n${own_style}" page "${page}")
string(REPLACE "@SCRIPT@" "/* This page contains:\n\n${licences}*/\n${script}" page "${page}")

set(mark "@DATA@")
string(FIND "${page}" "${mark}" before_length)
string(LENGTH "${mark}" mark_length)
math(EXPR after_start "${before_length} + ${mark_length}")
string(SUBSTRING "${page}" 0 ${before_length} before)
string(SUBSTRING "${page}" ${after_start} -1 after)
file(WRITE ${BUILD}/${PAGE}_before_data.html "${before}")
file(WRITE ${BUILD}/${PAGE}_after_data.html "${after}")

set(template [[
#include "apps/report/page_template.h"

asm(".pushsection .rodata, \"a\"\n"
    "legible_@PAGE@_before_data: .incbin \"@BUILD@/@PAGE@_before_data.html\"\n"
    "legible_@PAGE@_before_data_end:\n"
    "legible_@PAGE@_after_data: .incbin \"@BUILD@/@PAGE@_after_data.html\"\n"
    "legible_@PAGE@_after_data_end:\n"
    ".globl legible_@PAGE@_before_data, legible_@PAGE@_before_data_end\n"
    ".globl legible_@PAGE@_after_data, legible_@PAGE@_after_data_end\n"
    ".popsection\n");

extern "C" const char legible_@PAGE@_before_data[], legible_@PAGE@_before_data_end[];
extern "C" const char legible_@PAGE@_after_data[], legible_@PAGE@_after_data_end[];

namespace legible {

PageTemplate @FUNCTION@() {
  return {.before_data = {legible_@PAGE@_before_data, legible_@PAGE@_before_data_end},
          .after_data = {legible_@PAGE@_after_data, legible_@PAGE@_after_data_end}};
}

}  // namespace legible
]])
string(CONFIGURE "${template}" source @ONLY)
file(WRITE ${BUILD}/${PAGE}_template.cpp "${source}")
