"""What the regressions share: bags, processes, ears and judgement.

From the ground up; a module imports only modules further up in this list:

  files             the workspace's folders, real recordings
  simulated_bags    bags made by simulate_bag once and kept in the build folder
  recordings        the fixed set that scripts/regress measures
  results           its figures, beside those of the baseline
  processes         nodes, launch files and players as processes to start, stop and kill
  topics            messages turned into what is judged
  listener          everything that the three nodes say, as it comes
  judgement         accuracy against ground truth, rates, covariances
  processes_case    a test case that looks after processes and a folder
  live_case         the same with the three nodes, a player and a listener
"""
