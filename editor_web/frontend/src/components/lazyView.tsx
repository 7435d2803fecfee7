/** Views whose code is loaded when they are first shown, and loaded again after a load that failed. */
import { lazy, useState, type ComponentType } from 'react'

/** What gives each view that could not be loaded a new try. */
const failed = new Set<() => void>()

/** Let views that could not be loaded be loaded when they are mounted again; whoever has shown the failure says so. */
export function forgetFailedLoads(): void {
  failed.forEach((again) => again())
  failed.clear()
}

/** Put it inside a `Suspense` and a `ViewBoundary`, which a failed load is thrown to. */
export function lazyView<P extends object>(load: () => Promise<ComponentType<P>>): ComponentType<P> {
  const fresh = () =>
    lazy(async () => {
      try {
        return { default: await load() }
      } catch (error) {
        // React keeps a failure for ever.
        failed.add(() => (current = fresh()))
        throw error
      }
    })
  let current = fresh()
  return function LazyView(props: P) {
    const [Body] = useState(() => current)
    return <Body {...props} />
  }
}
