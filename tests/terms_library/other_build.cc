// A library that names another build, by a text that does not even end; what it
// would add must not be called.

extern "C" {
extern const char SplitFusionTermsBuild[4];
const char SplitFusionTermsBuild[4] = {'o', 'l', 'd', '\x01'};
void SplitFusionAddTerms(void* /*terms*/) { __builtin_trap(); }
}
