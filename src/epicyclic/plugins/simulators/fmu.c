/* Losses of a gear set from its loss map, as an FMU for Model Exchange and Co-Simulation (FMI 2.0).
 *
 * The outputs follow from the inputs at once, by linear interpolation. There are no states, but for
 * the temperature of an FMU that is HEATED by its losses: that one is integrated in fmi2DoStep. The
 * numbers are in map_data.h. Nothing of a C library is needed.
 */

#include "fmi2Functions.h"
#include "map_data.h"

/* FMI gives many functions more than they need here. */
#if defined(__GNUC__) || defined(__clang__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

enum { SPEED, TORQUE }; /* temperature and state follow, where the map has them */
enum { TORQUE_LOSS = AXES, POWER_LOSS, EFFICIENCY, FIRST_COMPONENT };
enum { OWN_TEMPERATURE = FIRST_COMPONENT + COMPONENTS, REALS = OWN_TEMPERATURE + HEATED };

#define STEP 0.05 /* of the integration at most, over the time constant */

typedef struct {
    double input[AXES]; /* if HEATED that of TEMPERATURE is the temperature of the surroundings */
    double temperature; /* of the gearbox, if HEATED */
    const fmi2CallbackFunctions *callbacks;
    fmi2String name;
} Instance;

#ifdef _WIN32
int DllMainCRTStartup(void *module, unsigned long reason, void *reserved) {
    return 1;
}
#endif

static int same(const char *one, const char *two) {
    while (*one && *one == *two) {
        one++;
        two++;
    }
    return *one == *two;
}

static fmi2Status fail(const Instance *it, const char *message) {
    if (it && it->callbacks->logger) {
        it->callbacks->logger(it->callbacks->componentEnvironment, it->name, fmi2Error, "error",
                              message);
    }
    return fmi2Error;
}

static double magnitude(double value) { return value < 0 ? -value : value; }

/* --- the map ---------------------------------------------------------------------------------- */

/* The number of a state next to a value; other axes are taken as they are. */
static double place(int axis, double value) {
    double last = axis_sizes[axis];
    if (axis != STATE) {
        return value;
    }
    return !(value > 1) ? 1 : value > last ? last : (double)(int)(value + 0.5);
}

/* The value below and the part of the way to the next; points outside are taken at the border. */
static int bracket(int axis, double value, double *part) {
    const double *values = axis_values[axis];
    int low = 0;
    int high = axis_sizes[axis] - 1;
    *part = 0;
    if (high == 0) {
        return 0;
    }
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (values[middle] <= value) {
            low = middle;
        } else {
            high = middle;
        }
    }
    *part = (value - values[low]) / (values[high] - values[low]);
    *part = *part < 0 ? 0 : *part > 1 ? 1 : *part;
    return low;
}

/* Where on an axis of the map it is. */
static double coordinate(const Instance *it, int axis) {
    return HEATED && axis == TEMPERATURE ? it->temperature : it->input[axis];
}

static int is_inside(const Instance *it) {
    for (int axis = 0; axis < AXES; axis++) {
        double low = axis_values[axis][0] - slack[axis];
        double high = axis_values[axis][axis_sizes[axis] - 1] + slack[axis];
        double value = coordinate(it, axis);
        if (!(value >= low && value <= high)) {
            return 0;
        }
        if (magnitude(value - place(axis, value)) > slack[axis]) {
            return 0;
        }
    }
    return 1;
}

/* Torque passed on over torque put in, at the reference shaft. */
static double efficiency(double speed, double torque, double torque_loss) {
    double driving = speed < 0 ? -torque : torque;
    if (driving > torque_loss) {
        return (driving - torque_loss) / driving;
    }
    return driving < 0 ? driving / (driving - torque_loss) : 0;
}

static void evaluate(const Instance *it, double *values) {
    double part[AXES];
    int low[AXES];
    double speed = magnitude(it->input[SPEED]);
    double torque_loss = 0;
    for (int axis = 0; axis < AXES; axis++) {
        values[axis] = it->input[axis];
        low[axis] = bracket(axis, place(axis, coordinate(it, axis)), &part[axis]);
    }
    for (int component = 0; component < COMPONENTS; component++) {
        double sum = 0;
        for (int corner = 0; corner < 1 << AXES; corner++) {
            double weight = 1;
            int node = 0;
            for (int axis = 0; axis < AXES; axis++) {
                int side = (corner >> axis) & 1;
                weight *= side ? part[axis] : 1 - part[axis];
                node = node * axis_sizes[axis] + low[axis] + side;
            }
            if (weight > 0) {
                sum += weight * torque_losses[component][node];
            }
        }
        values[FIRST_COMPONENT + component] = sum * speed;
        torque_loss += sum;
    }
    values[TORQUE_LOSS] = torque_loss;
    values[POWER_LOSS] = torque_loss * speed;
    values[EFFICIENCY] = efficiency(it->input[SPEED], it->input[TORQUE], torque_loss);
    if (HEATED) {
        values[OWN_TEMPERATURE] = it->temperature;
    }
}

/* --- the temperature -------------------------------------------------------------------------- */

/* Rise of the temperature in a second, at a temperature. */
static double rise(const Instance *it, double temperature) {
    double all[REALS];
    Instance there = *it;
    there.temperature = temperature;
    evaluate(&there, all);
    return (all[POWER_LOSS] - CONDUCTANCE * (temperature - it->input[TEMPERATURE])) / CAPACITY;
}

/* The classical method of Runge and Kutta, with the inputs as they are. */
static void warm_up(Instance *it, double step) {
    int count = (int)(step * CONDUCTANCE / CAPACITY / STEP) + 1;
    double h = step / count;
    for (int i = 0; i < count; i++) {
        double k1 = rise(it, it->temperature);
        double k2 = rise(it, it->temperature + h / 2 * k1);
        double k3 = rise(it, it->temperature + h / 2 * k2);
        double k4 = rise(it, it->temperature + h * k3);
        it->temperature += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
}

/* --- creation and life ------------------------------------------------------------------------ */

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count,
                               const fmi2String categories[]) {
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) {
    for (int axis = 0; axis < AXES; axis++) {
        ((Instance *)c)->input[axis] = start[axis];
    }
    if (HEATED) {
        ((Instance *)c)->temperature = start[TEMPERATURE];
    }
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible,
                              fmi2Boolean logging) {
    Instance *it;
    if (!callbacks || !callbacks->allocateMemory || !callbacks->freeMemory) {
        return NULL;
    }
    if (!guid || !same(guid, GUID)) {
        if (callbacks->logger) {
            callbacks->logger(callbacks->componentEnvironment, name, fmi2Error, "error",
                              "The GUID is not that of this FMU.");
        }
        return NULL;
    }
    it = callbacks->allocateMemory(1, sizeof(Instance));
    if (it) {
        it->callbacks = callbacks;
        it->name = name;
        fmi2Reset(it);
    }
    return it;
}

void fmi2FreeInstance(fmi2Component c) {
    if (c) {
        ((Instance *)c)->callbacks->freeMemory(c);
    }
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance,
                               fmi2Real begin, fmi2Boolean has_end, fmi2Real end) {
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

fmi2Status fmi2Terminate(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

/* --- variables -------------------------------------------------------------------------------- */

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference refs[], size_t count,
                       fmi2Real values[]) {
    double all[REALS];
    evaluate(c, all);
    for (size_t i = 0; i < count; i++) {
        if (refs[i] >= REALS) {
            return fail(c, "There is no real variable of this reference.");
        }
        values[i] = all[refs[i]];
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference refs[], size_t count,
                       const fmi2Real values[]) {
    for (size_t i = 0; i < count; i++) {
        if (refs[i] < AXES) {
            ((Instance *)c)->input[refs[i]] = values[i];
        } else if (HEATED && refs[i] == OWN_TEMPERATURE) {
            ((Instance *)c)->temperature = values[i];
        } else {
            return fail(c, "Only inputs can be set.");
        }
    }
    return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference refs[], size_t count,
                          fmi2Boolean values[]) {
    for (size_t i = 0; i < count; i++) {
        if (refs[i] != REALS) {
            return fail(c, "There is no Boolean variable of this reference.");
        }
        values[i] = is_inside(c) ? fmi2True : fmi2False;
    }
    return fmi2OK;
}

/* Functions for variables and abilities that this FMU does not have: nothing to do, or an error. */
#define NONE(name, type)                                                                           \
    fmi2Status name(fmi2Component c, const fmi2ValueReference refs[], size_t count, type) {        \
        return count ? fail(c, #name ": there are no such variables.") : fmi2OK;                   \
    }

NONE(fmi2GetInteger, fmi2Integer values[])
NONE(fmi2GetString, fmi2String values[])
NONE(fmi2SetInteger, const fmi2Integer values[])
NONE(fmi2SetBoolean, const fmi2Boolean values[])
NONE(fmi2SetString, const fmi2String values[])

#define UNABLE(name, ...)                                                                          \
    fmi2Status name(fmi2Component c, __VA_ARGS__) { return fail(c, #name ": cannot be done."); }

UNABLE(fmi2GetFMUstate, fmi2FMUstate *state)
UNABLE(fmi2SetFMUstate, fmi2FMUstate state)
UNABLE(fmi2FreeFMUstate, fmi2FMUstate *state)
UNABLE(fmi2SerializedFMUstateSize, fmi2FMUstate state, size_t *size)
UNABLE(fmi2SerializeFMUstate, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
UNABLE(fmi2DeSerializeFMUstate, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
UNABLE(fmi2GetDirectionalDerivative, const fmi2ValueReference unknown[], size_t unknowns,
       const fmi2ValueReference known[], size_t knowns, const fmi2Real dknown[],
       fmi2Real dunknown[])
UNABLE(fmi2SetRealInputDerivatives, const fmi2ValueReference refs[], size_t count,
       const fmi2Integer order[], const fmi2Real value[])
UNABLE(fmi2GetRealOutputDerivatives, const fmi2ValueReference refs[], size_t count,
       const fmi2Integer order[], fmi2Real value[])
UNABLE(fmi2GetStatus, const fmi2StatusKind kind, fmi2Status *value)
UNABLE(fmi2GetRealStatus, const fmi2StatusKind kind, fmi2Real *value)
UNABLE(fmi2GetIntegerStatus, const fmi2StatusKind kind, fmi2Integer *value)
UNABLE(fmi2GetBooleanStatus, const fmi2StatusKind kind, fmi2Boolean *value)
UNABLE(fmi2GetStringStatus, const fmi2StatusKind kind, fmi2String *value)

/* --- simulation ------------------------------------------------------------------------------- */

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_return) {
    if (c && HEATED) {
        warm_up(c, step);
    }
    return c ? fmi2OK : fmi2Error;
}

fmi2Status fmi2CancelStep(fmi2Component c) { return fail(c, "fmi2CancelStep: cannot be done."); }

fmi2Status fmi2EnterEventMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    info->newDiscreteStatesNeeded = fmi2False;
    info->terminateSimulation = fmi2False;
    info->nominalsOfContinuousStatesChanged = fmi2False;
    info->valuesOfContinuousStatesChanged = fmi2False;
    info->nextEventTimeDefined = fmi2False;
    return c ? fmi2OK : fmi2Error;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean no_return,
                                       fmi2Boolean *enter_event_mode, fmi2Boolean *terminate) {
    *enter_event_mode = fmi2False;
    *terminate = fmi2False;
    return c ? fmi2OK : fmi2Error;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) { return c ? fmi2OK : fmi2Error; }

#define NO_STATES(name, type)                                                                      \
    fmi2Status name(fmi2Component c, type, size_t count) {                                         \
        return count ? fail(c, #name ": there are no states.") : fmi2OK;                           \
    }

NO_STATES(fmi2SetContinuousStates, const fmi2Real values[])
NO_STATES(fmi2GetDerivatives, fmi2Real values[])
NO_STATES(fmi2GetEventIndicators, fmi2Real values[])
NO_STATES(fmi2GetContinuousStates, fmi2Real values[])
NO_STATES(fmi2GetNominalsOfContinuousStates, fmi2Real values[])
