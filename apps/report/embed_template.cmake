# Joins template.html, styles.css and the bundle into one page, cut in two where the data go, and writes a C++
# source whose assembler includes both parts byte by byte.
# Called with -DSOURCE=<this folder> -DBUILD=<its build folder, with report.js and node_modules>.

file(READ ${SOURCE}/template.html page)
file(READ ${SOURCE}/styles.css style)
file(READ ${BUILD}/report.js script)

# The licences of what is bundled ask to be passed on.
set(licences "")
foreach(package @observablehq/plot d3 d3-ease d3-scale-chromatic)
  file(READ ${BUILD}/node_modules/${package}/LICENSE licence)
  string(APPEND licences "${package}\n\n${licence}\n")
endforeach()

string(REPLACE "@STYLE@" "${style}" page "${page}")
string(REPLACE "@SCRIPT@" "/* This page contains:\n\n${licences}*/\n${script}" page "${page}")

set(mark "@DATA@")
string(FIND "${page}" "${mark}" before_length)
string(LENGTH "${mark}" mark_length)
math(EXPR after_start "${before_length} + ${mark_length}")
string(SUBSTRING "${page}" 0 ${before_length} before)
string(SUBSTRING "${page}" ${after_start} -1 after)
file(WRITE ${BUILD}/page_before_data.html "${before}")
file(WRITE ${BUILD}/page_after_data.html "${after}")

file(WRITE ${BUILD}/report_template.cpp [[
#include "apps/report/page_template.h"

asm(".pushsection .rodata, \"a\"\n"
    "legible_page_before_data: .incbin \"@BUILD@/page_before_data.html\"\n"
    "legible_page_before_data_end:\n"
    "legible_page_after_data: .incbin \"@BUILD@/page_after_data.html\"\n"
    "legible_page_after_data_end:\n"
    ".globl legible_page_before_data, legible_page_before_data_end\n"
    ".globl legible_page_after_data, legible_page_after_data_end\n"
    ".popsection\n");

extern "C" const char legible_page_before_data[], legible_page_before_data_end[];
extern "C" const char legible_page_after_data[], legible_page_after_data_end[];

namespace legible {

std::string_view PageBeforeData() { return {legible_page_before_data, legible_page_before_data_end}; }
std::string_view PageAfterData() { return {legible_page_after_data, legible_page_after_data_end}; }

}  // namespace legible
]])
configure_file(${BUILD}/report_template.cpp ${BUILD}/report_template.cpp @ONLY)
