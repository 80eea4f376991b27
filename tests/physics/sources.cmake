set(PHYSICS_TEST_SOURCES
  physics/furnaces.cpp
  physics/pairs.cpp
  physics/passes.cpp
  physics/rooms.cpp
  physics/shadows.cpp
  physics/solvers.cpp
)
