"""Times mrcal's optimiser on the problem that board_bench writes: board_bench runs this with Debian's python3."""

import json
import sys
import time

import mrcal
import numpy as np


def main():
    with open(sys.argv[1]) as file:
        problem = json.load(file)
    views = len(problem["frames"])
    observations = np.ones((views, problem["rows"], problem["columns"], 3))
    for view, column, row, x, y in problem["corners"]:
        observations[view, row, column, :2] = x, y
    of_frame = np.zeros((views, 3), dtype=np.int32)
    of_frame[:, 0] = np.arange(views)
    of_frame[:, 2] = -1
    times, result = [], None
    for _ in range(problem["repetitions"]):
        inputs = dict(
            intrinsics=np.array([problem["intrinsics"]]),
            extrinsics_rt_fromref=np.zeros((0, 6)),
            frames_rt_toref=np.array(problem["frames"]),
            points=None,
            observations_board=observations.copy(),
            indices_frame_camintrinsics_camextrinsics=of_frame,
            observations_point=None,
            indices_point_camintrinsics_camextrinsics=None,
            lensmodel="LENSMODEL_OPENCV8",
            imagersizes=np.array([problem["size"]], dtype=np.int32),
            calobject_warp=None,
            do_optimize_calobject_warp=False,
            do_optimize_extrinsics=False,
            calibration_object_spacing=problem["spacing_m"],
            do_apply_outlier_rejection=False,
            do_apply_regularization=False,
            verbose=False,
        )
        start = time.perf_counter()
        stats = mrcal.optimize(**inputs)
        times.append(time.perf_counter() - start)
        residuals = stats["x"][: 2 * len(problem["corners"])]
        result = inputs["intrinsics"][0, 0], np.sqrt(np.sum(residuals**2) / len(problem["corners"]))
    print(json.dumps({"median_s": float(np.median(times)), "fx": float(result[0]), "rms_px": float(result[1])}))


main()
