# Run when a test program PROGRAM of ROOM has been built: writes its suites to ENTRIES, which ctest reads. In the
# program's own list a suite's name ends in a dot; its tests follow, indented.

# What takes longest, longest first, so that none is left alone at the end. Only an order: a name may be missing.
set(longest Scenario BedActs OperationErrors StandardBedActsInAFourthOrder StandardBedActsInAThirdOrder
    StandardBedActsInASecondOrder StandardBedActs Run Pinch Anatomy GoldenProject IdleHands Golden StepBudget Motion
    RandomActs JawMouldGrasp World MainScenario WoundsOfCurrent Mutations RecordingFile Rubbing Documents Threads
    ScoredClass Slip StrandJoin StructuralExtension Solid Bench SelfContact Usage ChangedBodies SlidingContact
    RandomGrasps RandomPaths WorldBytes SkinJoin RestCache Live TwoGraspers Equilibrium Validation)

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n[^ \n]+\\." suites "\n${list}")
set(text "")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "^\n(.*)\\.$" "\\1" suite "${suite}")
  get_filename_component(name "${suite}" NAME)  # without the prefix of a set of parameters
  list(FIND longest "${name}" place)
  set(cost 0)
  if(NOT place EQUAL -1)
    math(EXPR cost "100 - ${place}")
  endif()
  string(APPEND text
    "add_test([[${ROOM}.${suite}]] [[${PROGRAM}]] [[--gtest_filter=${suite}.*]])\n"
    "set_tests_properties([[${ROOM}.${suite}]] PROPERTIES LABELS ${ROOM} COST ${cost} TIMEOUT 3600)\n")
endforeach()
file(WRITE ${ENTRIES} "${text}")
