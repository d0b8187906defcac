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
  text_table, json_report, plots, svg, html_report
  command_line       arguments and exit codes
"""
