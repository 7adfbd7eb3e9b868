// What a camera's calibration is worth, in words.
#pragma once

#include <string>
#include <vector>

#include "apps/intrinsics_run.h"

namespace legible {

// What the user has to know before believing the numbers; nothing where there is no camera.
std::vector<std::string> Warnings(const IntrinsicsRun& run);

// Whether two halves of the views lead to the same camera, in a sentence.
std::string HalvesSentence(const IntrinsicsRun& run);

std::string CoverageSentence(const IntrinsicsRun& run);

// Where to hold the board for the next image; empty where there is none to propose.
std::string NextViewSentence(const IntrinsicsRun& run);

// "36 tags of tag36h11", "a chessboard of 9 x 6 corners".
std::string BoardText(const Board& board);

// "at the boards' distance (0.71 m)", "infinitely far away".
std::string DistanceText(const IntrinsicsRun& run, double distance_m);

// Of the board, in sight or expected to be, by the detection or by the file of corners.
int CornersNotMeasured(const IntrinsicsRun& run);

int ViewsUsed(const BoardCalibration& result);
int CornersOf(const BoardCalibration& result);           // of the views that have a part, outliers too
int CornersWeighedDown(const BoardCalibration& result);  // weights between 0 and 1

}  // namespace legible
