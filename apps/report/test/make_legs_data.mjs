// Writes example data of the page of `legible legs`: node make_legs_data.mjs quattro|hexapod|none > DATA.json
// Robots bend as they should; verdicts, errors and singularities are made up, and only fit one another.
import { fromRotationVector, moved, norm, placed, plus, rotationAngle, times } from "./example_geometry.mjs";
import { Random } from "./example_random.mjs";

const random = new Random(5);
const around = (value) => value * random.between(0.6, 1.6);
const pose = (translation, turn = [0, 0, 0]) => ({
  rotation_xyzw: fromRotationVector(turn),
  translation_m: translation,
});

// Legs {base, joint (in platform), startAt(C)}: the start of the seen segment, null where C is out of reach.
const onCircle = (radius, angle, z = 0) => [radius * Math.cos(angle), radius * Math.sin(angle), z];

function hexapod() {
  const legs = [0, 1, 2, 3, 4, 5].map((index) => {
    const third = (2 * Math.PI * Math.floor(index / 2)) / 3;
    const side = index % 2 ? 1 : -1;
    const base = onCircle(0.27, third + side * 0.12);
    return { base, joint: onCircle(0.19, third + side * 0.9), radius: 0.012, startAt: () => base };
  });
  return {
    name: "Example hexapod",
    platform: "spatial",
    freedoms: 6,
    chain: "U_PS",
    hidden: "_UPS",
    legs,
    from: pose([0.02, -0.01, 0.33], [0, 0.05, 0.1]),
    to: pose([0.05, 0.02, 0.36], [0.1, 0, 0.4]),
    free: [0, 1, 2, 3, 4, 5],
  };
}

const ARM_M = 0.38;
const ROD_M = 0.825;

// An arm in the vertical plane through the axis, with its elbow outward.
function elbow(base, angle, c) {
  const outward = [Math.cos(angle), Math.sin(angle), 0];
  const [x, y, z] = plus(c, base, -1);
  const along = x * outward[0] + y * outward[1];
  const across = x * outward[1] - y * outward[0];
  const reach = Math.hypot(along, z);
  const cosine = (ARM_M ** 2 + reach ** 2 - (ROD_M ** 2 - across ** 2)) / (2 * ARM_M * reach);
  if (!(Math.abs(cosine) < 1)) return null;
  const turn = Math.atan2(z, along) + Math.acos(cosine);
  return plus(plus(base, outward, ARM_M * Math.cos(turn)), [0, 0, 1], ARM_M * Math.sin(turn));
}

function quattro() {
  const legs = [-3, -1, 1, 3].map((quarter) => {
    const angle = (quarter * Math.PI) / 4;
    const base = onCircle(0.275, angle);
    return { base, joint: onCircle(0.07, angle), radius: 0.01, startAt: (c) => elbow(base, angle, c) };
  });
  return {
    name: "Example Quattro",
    platform: "schoenflies",
    freedoms: 4,
    chain: "_R-{2-US}",
    hidden: "Π-_{2-UU}",
    legs,
    from: pose([0, 0, -0.75]),
    to: pose([-0.2, 0, -0.56]),
    free: [0, 1, 2, 5],
  };
}

function parallelRails() {
  const legs = [-1, 1].map((side) => {
    const base = [0.3 * side, 0, 0];
    const startAt = ([x, y]) => plus(base, [0, 1, 0], y - Math.sqrt(0.3 ** 2 - (x - base[0]) ** 2));
    return { base, joint: [0, 0, 0], radius: 0.01, startAt };
  });
  return {
    name: "Two parallel rails",
    platform: "planar-point",
    freedoms: 2,
    chain: "_PRR",
    hidden: "P_RR",
    legs,
    from: pose([0.02, 0.2, 0]),
    to: pose([0.1, 0.35, 0]),
    free: [0, 1],
  };
}

const placesAt = ({ legs }, at) =>
  legs.map(({ joint, startAt }) => {
    const platform = placed(at, joint);
    return { start_m: startAt(platform), platform_joint_m: platform };
  });

const apart = (a, b) => ({
  position_from_goal_m: norm(plus(a.translation_m, b.translation_m, -1)),
  rotation_from_goal_rad: rotationAngle(a.rotation_xyzw, b.rotation_xyzw),
});

function twist({ free }, size) {
  const vector = [0, 0, 0, 0, 0, 0];
  for (const axis of free) vector[axis] = size * random.normal();
  return vector;
}

function controllability(robot, shown, why) {
  const unseen = Array.from({ length: robot.freedoms - shown }, () => {
    const motion = twist(robot, 1);
    return times(motion, 1 / norm(motion));
  });
  const status = shown === robot.freedoms ? "controllable" : "uncontrollable";
  return {
    status,
    freedoms: robot.freedoms,
    seen_freedoms: shown,
    unseen_twists: unseen,
    why: status === "controllable" ? "" : why,
  };
}

function modesOf(robot, count) {
  const at = [
    robot.to,
    ...Array.from({ length: count }, (_, index) => moved(robot.to, twist(robot, 0.06 * (index + 1)))),
  ];
  return at.map((each, index) => ({
    base_from_platform: each,
    ...apart(each, robot.to),
    has_own_working_modes: index % 3 !== 2,
    largest_direction_error: index === 0 ? 0 : around(1e-15),
    within_joint_ranges: [true, false, null][index % 3],
  }));
}

const halfway = ({ from, to }, share) =>
  pose(plus(times(from.translation_m, 1 - share), to.translation_m, share), [0, 0, 0]);

function way(robot, verdict) {
  const free = verdict === "free" ? 1 : random.between(0.2, 0.8);
  return {
    verdict,
    pieces: Math.round(around(40)),
    free_up_to: free,
    pose_there: verdict === "free" ? robot.to : halfway(robot, free),
    why: {
      free: "",
      singular: "start and goal lie on either side of a singularity: no path avoids it",
      undecided: "the path passes a singularity there, or very near to one",
    }[verdict],
    is_the_simulated_way: false,
  };
}

const error = (size) => ({ position_m: around(3e-3) * size, rotation_rad: around(2e-2) * size });

// Exponential, with a rest that is left of the errors.
function curves(robot, legs, rest) {
  const time_s = Array.from({ length: 240 }, (_, index) => index / 12);
  const begin = apart(robot.from, robot.to);
  const fall = (from) => time_s.map((time) => from * (Math.exp(-0.8 * time) + rest));
  return {
    time_s,
    errors_rad: legs.map(() => fall(around(0.1))),
    position_from_goal_m: fall(begin.position_from_goal_m),
    rotation_from_goal_rad: fall(begin.rotation_from_goal_rad),
  };
}

function simulation(robot, found, rest) {
  const last = (values) => values.at(-1);
  return {
    end: rest > 0 ? "local-minimum" : "converged",
    time_s: last(found.time_s),
    base_from_platform: rest > 0 ? moved(robot.to, twist(robot, 0.1)) : robot.to,
    position_from_goal_m: last(found.position_from_goal_m),
    rotation_from_goal_rad: last(found.rotation_from_goal_rad),
    largest_direction_error_rad: Math.max(...found.errors_rad.map(last)),
  };
}

const subsets = (count) =>
  Array.from({ length: 2 ** count - 1 }, (_, bits) =>
    Array.from({ length: count }, (__, leg) => leg + 1).filter((leg) => ((bits + 1) >> (leg - 1)) & 1),
  );

const RANKS = ["possible", "arrives", "undecided", "other-aspect", "uncontrollable"];
const WHY = {
  possible: "",
  arrives:
    "the path passes a singularity there, or very near to one; simulated, the servo arrives, which is no proof",
  undecided: "the path passes a singularity there, or very near to one; simulated, the servo ends elsewhere",
  "other-aspect": "start and goal lie on either side of a singularity: no path avoids it",
};
const PATH_OF = {
  possible: "free",
  arrives: "undecided",
  undecided: "undecided",
  "other-aspect": "singular",
};

// perLeg: motions that a leg's direction shows, and its line; a verdict for each set that holds the platform.
function judged(robot, legs, perLeg, verdict) {
  const shown = (each) => Math.min(robot.freedoms, each * legs.length);
  const byDirections = controllability(
    robot,
    shown(perLeg.direction),
    `the seen directions have ${shown(perLeg.direction)} coordinates for the platform’s ${robot.freedoms} freedoms`,
  );
  const byLines = controllability(
    robot,
    shown(perLeg.line),
    "the platform can turn about an axis with no line moving",
  );
  const common = { legs, controllability: byDirections, by_lines: byLines };
  if (byDirections.status !== "controllable")
    return {
      set: {
        ...common,
        verdict: "uncontrollable",
        why: byDirections.why,
        path: null,
        assembly_modes: null,
        largest_error_at_goal: null,
        largest_error_on_path: null,
        simulation: null,
      },
    };
  const isSimulated = verdict === "arrives" || verdict === "undecided";
  const rest = verdict === "undecided" ? 0.2 : 0;
  const found = isSimulated ? curves(robot, legs, rest) : null;
  const isLeast = shown(perLeg.direction) - perLeg.direction * legs.length === 0;
  const at = error(1.5 / legs.length);
  return {
    found,
    set: {
      ...common,
      verdict,
      why: WHY[verdict],
      path: way(robot, PATH_OF[verdict]),
      assembly_modes: {
        status: isLeast || legs.length % 2 ? "complete" : "incomplete",
        most_possible: isLeast ? 8 : 0,
        why: isLeast || legs.length % 2 ? "" : "2 of the 8 roots are multiple or at infinity",
        modes: modesOf(robot, isLeast ? 1 + Math.floor(random.between(0, 5)) : 0),
        with_a_reversed_leg: isLeast ? Math.floor(random.between(0, 3)) : 0,
      },
      largest_error_at_goal: at,
      largest_error_on_path: { position_m: 1.2 * at.position_m, rotation_rad: 1.1 * at.rotation_rad },
      simulation: found && simulation(robot, found, rest),
    },
  };
}

function verdictFor(legs) {
  if (legs.length > 3) return "possible";
  return RANKS[[0, 3, 0, 2, 0, 1, 3][(legs[0] + 3 * legs.at(-1)) % 7]];
}

function ranked(robot, perLeg) {
  const all = subsets(robot.legs.length).map((legs) => judged(robot, legs, perLeg, verdictFor(legs)));
  const size = ({ set }) => set.largest_error_at_goal?.position_m ?? 0;
  all.sort((a, b) => RANKS.indexOf(a.set.verdict) - RANKS.indexOf(b.set.verdict) || size(a) - size(b));
  const [best] = all;
  if (best.set.verdict === "possible") {
    best.found = curves(robot, best.set.legs, 0);
    best.set.simulation = simulation(robot, best.found, 0);
  }
  return all;
}

// Over x and z, with the singularity of the hidden robot along a curve and that of the real one at a height.
function mapsOf(robot, sets) {
  const x = Array.from({ length: 37 }, (_, index) => -0.45 + 0.025 * index);
  const z = Array.from({ length: 29 }, (_, index) => -1.0 + 0.025 * index);
  const grid = (of) => z.map((height) => x.map((aside) => of(aside, height)));
  const state = (aside, height) => {
    const off = Math.hypot(aside, height + 0.55);
    return off > 0.45 ? "out-of-reach" : off > 0.36 ? "outside-joint-ranges" : "fine";
  };
  const within = (of) =>
    grid((aside, height) => (state(aside, height) === "out-of-reach" ? null : of(aside, height)));
  const ofRobot = (aside, height) => height + 0.92 - 0.2 * aside;
  const ofSet =
    ([first]) =>
    (aside, height) =>
      0.13 * first - 0.05 + aside - 1.5 * (height + 0.6) ** 2;
  const measure = (of) => (aside, height) => Math.min(1, 0.9 * Math.abs(of(aside, height)));
  const errors = (of, size) => (aside, height) => {
    const near = Math.abs(of(aside, height));
    return near < 0.008 ? null : size / near;
  };
  const typeOne = (aside, height) => Math.max(0, 1 - 2 * Math.hypot(aside, height + 0.55));
  const { translation_m: t } = robot.to;
  return {
    x: { coordinate: "x", unit: "m", values: x },
    y: { coordinate: "z", unit: "m", values: z },
    held: { x: t[0], y: t[1], z: t[2], rx: 0, ry: 0, rz: 0 },
    robot: {
      states: grid(state),
      type_2_geometric: within(ofRobot),
      type_2_matrix: within(measure(ofRobot)),
      type_1: within(typeOne),
    },
    sets: sets
      .filter(({ assembly_modes: modes }) => modes)
      .slice(0, 4)
      .map(({ legs }, index) => ({
        legs,
        type_2_geometric: index === 3 ? grid(() => null) : within(ofSet(legs)),
        type_2_matrix: within(measure(ofSet(legs))),
        type_1: within(typeOne),
        position_error_m: within(errors(ofSet(legs), 4e-4)),
        rotation_error_rad: within(errors(ofSet(legs), 3e-3)),
      })),
  };
}

function dataOf(robot, perLeg, further) {
  const all = ranked(robot, perLeg);
  const sets = all.map(({ set }) => set);
  const [best] = sets;
  const isChosen = best.verdict === "possible";
  const document = {
    robot: robot.name,
    platform: robot.platform,
    from: robot.from,
    to: robot.to,
    noise_rad: 0.1 * (Math.PI / 180),
    legs: robot.legs.map((_, index) => ({
      leg: index + 1,
      chain: robot.chain,
      hidden_chain: robot.hidden,
      why_not_controllable: perLeg.why ?? null,
    })),
    robot_path: way(robot, isChosen ? "free" : "undecided"),
    sets,
    choice: isChosen ? best.legs : null,
    why_no_choice: isChosen ? null : "no set of legs leads to the goal",
    warnings: isChosen
      ? []
      : ["the straight way of the robot itself, all joints held: the path passes a singularity"],
    maps: null,
    robot_modes: null,
    ...further(robot, sets),
  };
  return {
    title: robot.name,
    program_version: "0.2.0",
    model: "robot.yaml",
    robot: { legs: robot.legs.map(({ base, radius }) => ({ base_joint_m: base, radius_m: radius })) },
    places: {
      from: placesAt(robot, robot.from),
      to: placesAt(robot, robot.to),
      modes: sets.map(
        ({ assembly_modes: modes }) =>
          modes?.modes.map((mode) => placesAt(robot, mode.base_from_platform)) ?? null,
      ),
    },
    simulations: all.map(({ found }) => found ?? null),
    document,
  };
}

const ownModes = (robot) => ({
  robot_modes: {
    status: "incomplete",
    why: "28 of 40 complex roots are certified; 12 seem to be at infinity",
    most_possible: 40,
    modes: modesOf(robot, 5).map(
      ({ base_from_platform, position_from_goal_m, rotation_from_goal_rad, largest_direction_error }) => ({
        base_from_platform,
        position_from_goal_m,
        rotation_from_goal_rad,
        largest_length_error_m: largest_direction_error,
      }),
    ),
  },
});

const KINDS = {
  quattro: () =>
    dataOf(quattro(), { direction: 2, line: 3 }, (robot, sets) => ({ maps: mapsOf(robot, sets) })),
  hexapod: () => dataOf(hexapod(), { direction: 2, line: 2 }, ownModes),
  none: () =>
    dataOf(
      parallelRails(),
      { direction: 0.5, line: 2, why: "the rails of the P joints are parallel" },
      () => ({}),
    ),
};
const rounded = (_, value) => (typeof value === "number" ? Number(value.toPrecision(7)) : value);
console.log(JSON.stringify(KINDS[process.argv[2]](), rounded));
