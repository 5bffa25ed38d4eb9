// Of what it is made, and its loop for whatever chip and clock there are.

#include "target/run/executor.h"

#include "target/run/executor_loop.h"

namespace lyr::run {

Executor::Executor(gpio::GpioChip& chip, gpio::Clock& clock, ExecutorTiming timing,
                   const StopRequests& stop_requests, Marks* marks, const WantedPace* wanted_pace)
    : chip_(chip),
      clock_(clock),
      timing_(timing),
      stop_requests_(stop_requests),
      marks_(marks),
      wanted_pace_(wanted_pace),
      run_(&Executor::run<gpio::GpioChip, gpio::Clock>) {}

}  // namespace lyr::run
