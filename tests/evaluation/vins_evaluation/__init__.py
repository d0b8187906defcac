"""Accuracy of estimated trajectories against ground truth.

From the ground up; a module imports only modules further up in this list:

  errors             what a user can put right
  rotations          unit quaternions, many at a time
  trajectory         stamped poses and their interpolation
  pose_collector     the checks that every pose passes on its way in
  trajectory_files   TUM and csv text files
  bag_topics         topics of rosbags
  sources            what a command-line argument means
  alignment          which frame to compare in
  metrics            absolute errors, completeness
  relative_error     errors over distances
  evaluation         all of the above for several estimates
  figures            the figures that the reports show, and which one is best
  style, svg         how plots look, and SVG that can stand in a page
  text_table, json_report, plots, html_report
  run_folder         what run_bag has written
  run_figures, place_figures   the figures of docs/how_it_works
  command_line       arguments and exit codes
"""
