//! End of `--help`: exit codes and examples. Examples run as printed from the project's folder, in the order given (`tests/help.rs` runs them);
//! the comment of one that no test can run says why in brackets: (takes minutes), (takes hours), (opens a window) or (serves until stopped).

/// After the list of commands.
pub(super) const PROGRAM: &str = "\
The usual order:
  look       idc run scenarios/deburred_edge.toml, then report.html in a
             browser and recording.rrd in Rerun; idc compare sets runs side by
             side
  own cell   idc new cell, idc check, idc run, idc vary, idc design
  own rig    idc new import, idc import, idc new rig, idc check, idc diagnose,
             idc fleet
  proof      idc prove, idc prove --sweep
Every command's --help ends with examples.

With --json, results go to standard output and an error to standard error, as
one JSON object each. Results that stand are replaced with --force only; a page
that idc report writes anew in its own folder holds the same.
Colours and progress show in a terminal alone; NO_COLOR is honoured.

Exit codes:
  0  done
  1  a result lies outside the scenario's [expect] bounds, no design keeps the
     study's [limits], or a proof's score is below what is claimed
  2  bad input, or an output that cannot be written or stands already: nothing
     was simulated, nothing was changed (of many cases: the others are done)
  3  the physics stopped the run; the recording up to there is kept

From a clone to the diagnosis of your own log: docs/FIRST-DIAGNOSIS.md

Examples:
  # The job itself: a burr ground off in two passes, a chamfer left.
  idc run scenarios/deburred_edge.toml
  # The force alone: 280 mm of edge ridden at 150 N.
  idc run scenarios/plate_edge.toml
  # What a command does, and how.
  idc help run";

/// `idc run`.
pub(super) const RUN: &str = "\
With --set, any key of the scenario has another value; of several values each is
run, into a folder of its own, of several --set each combination, the last one
changing first. List elements count from 0 (command[0].force_n); a text with a
comma stands in quotes. Everything is checked before anything is run; each
folder's varied.toml is the scenario that was run there.

Exit codes: 0 done, 1 a result outside [expect], 2 bad input, 3 stopped by the
physics (the recording up to there is kept); of several runs that of the worst.

Examples:
  # The nominal job; recording, samples and summary go to runs/first.
  idc run scenarios/plate_edge.toml --out runs/first
  # The same again, in place of what is there.
  idc run scenarios/plate_edge.toml --out runs/first --force
  # Numbers, samples and page alone, as for a run in a test.
  idc run scenarios/plate_edge.toml --out runs/guard --no-recording
  # With recording.mcap for Foxglove and ros2 bag.
  idc run scenarios/plate_edge.toml --out runs/messages --mcap
  # Watched in a viewer while it goes on. (opens a window)
  idc run scenarios/plate_edge.toml --out runs/watched --view
  # Three feeds side by side: a folder each, and compare.html.
  idc run scenarios/plate_edge.toml --out runs/feeds \\
      --set process.feed_mm_per_s=10,20,40
  # The device alone, on a bench; its numbers as JSON.
  idc run scenarios/paper_step.toml --out runs/step --json";

/// `idc design`.
pub(super) const DESIGN: &str = "\
Exit codes: 0 done, 1 no design keeps [limits], 2 bad input.

Examples:
  # A first look: few designs are tried.
  idc design scenarios/studies/device_design.toml --out runs/look \\
      --evaluations 40
  # The study as it is written. (takes minutes)
  idc design scenarios/studies/device_design.toml --out runs/device";

/// `idc edges`.
pub(super) const EDGES: &str = "\
Exit codes: 0 done, 2 bad input.

Examples:
  # Their numbers are what [workpiece.edge] of a scenario asks for.
  idc edges assets/bracket.stl
  # A page with the part in 3D: an edge that is picked shows the lines that a
  # scenario needs. It is one file and asks for no network.
  idc edges assets/bracket.stl --out runs/bracket_edges.html
  # The same for a program, with a greater angle for what counts as sharp.
  idc edges assets/bracket.stl --sharp-angle-deg 60 --json";

/// `idc predict`.
pub(super) const PREDICT: &str = "\
Exit codes: 0 done, 2 bad input.

Examples:
  # What the nominal rig makes of a recording's inputs, and how far off it is.
  idc predict assets/proof/cases/case-03/rig.toml \\
      assets/proof/cases/case-03/ride.csv --out runs/nominal.csv
  # The same as numbers for a program.
  idc predict assets/proof/cases/case-03/rig.toml \\
      assets/proof/cases/case-03/ride.csv --out runs/again.csv --json
  # Several recordings in one call, a file each in a folder.
  idc predict assets/proof/cases/case-03/rig.toml \\
      assets/proof/cases/case-03/*.csv --out runs/predictions";

/// `idc import`.
pub(super) const IMPORT: &str = "\
assets/import/README.md lists every key, unit and form of a map.
Exit codes: 0 done, 2 bad input.

Examples:
  # What is in a log of a data logger; nothing is written.
  idc import assets/first/map.toml assets/first/ride.csv
  # A recording of each log, into a folder.
  idc import assets/first/map.toml assets/first/*.csv --out runs/imported/
  # What idc run --mcap writes needs no map.
  idc run scenarios/plate_edge.toml --out runs/messages --mcap
  idc import runs/messages/recording.mcap --out runs/messages/back.parquet";

/// `idc diagnose`.
pub(super) const DIAGNOSE: &str = "\
diagnosis.json is written last: where it stands, the others are complete.
Exit codes: 0 done, 2 bad input (with --all: of any case; the others are done).

Examples:
  # One case: its rig.toml names its recordings.
  idc diagnose assets/proof/cases/case-03 --out runs/cases/case-03
  # What was found, for a program; the diagnosis that stands is kept.
  idc diagnose assets/proof/cases/case-03 --out runs/cases/case-03 \\
      --resume --json
  # Every case below a folder, going on where it was stopped. (takes minutes)
  idc diagnose assets/proof/cases --all --out runs/cases --resume
  # Cases of a robot cell: the scenario is the nominal model. (takes minutes)
  idc diagnose recordings --all --scenario cell.toml --out runs/cell";

/// `idc prove`.
pub(super) const PROVE: &str = "\
Exit codes: 0 the score is as good as claimed, 1 it is not, 2 bad input.

Examples:
  # One of the cases that come with the project.
  idc prove --only case-03 --out runs/proof-3
  # All of them. (takes minutes)
  idc prove
  # A sweep over effects and sizes: here one device with one effect, and one
  # with nothing missing.
  idc prove --sweep --out runs/few --effects hose_volume --sizes 1 --seeds 1 \\
      --empty 1
  # Go on where it was stopped; here all is done, and the tables are written.
  idc prove --sweep --out runs/few --effects hose_volume --sizes 1 --seeds 1 \\
      --empty 1 --resume --quiet
  # Everything. (takes hours)
  idc prove --sweep --out runs/sweep --page docs/CONFUSION.md --force
  # Sixty devices with a law each that no list holds. (takes hours)
  idc prove --sweep --laws 60 --out runs/laws";

/// `idc laboratory`.
pub(super) const LABORATORY: &str = "\
Exit codes: 0 done, 2 bad input.

Examples:
  # The ten cases of assets/proof, made anew.
  idc laboratory --out runs/laboratory
  # Two devices with a law each that no list holds, for `idc diagnose`.
  idc laboratory --laws 2 --out runs/laws-cases";
