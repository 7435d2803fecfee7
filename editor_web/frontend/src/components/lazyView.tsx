/** Views whose code is loaded when they are first shown, and loaded again after a load that failed. */
import { lazy, useState, type ComponentType } from 'react'

/** Put it inside a `Suspense`; a failed load is thrown, and mounting the view again tries again. */
export function lazyView<P extends object>(load: () => Promise<ComponentType<P>>): ComponentType<P> {
  const fresh = () =>
    lazy(async () => {
      try {
        return { default: await load() }
      } catch (error) {
        // React keeps a failure for ever; the next mount gets a view that has not failed yet.
        current = fresh()
        throw error
      }
    })
  let current = fresh()
  return function LazyView(props: P) {
    const [Body] = useState(() => current)
    return <Body {...props} />
  }
}
