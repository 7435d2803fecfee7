/** Views whose code is loaded when they are first shown, and loaded again after a load that failed. */
import { createContext, useContext, useEffect, useState, type ComponentType, type ReactNode } from 'react'

/** What stands in the place of a view while its code is loaded. */
export const WhileLoading = createContext<ReactNode>(null)

/** What gives each view that could not be loaded a new try. */
const failed = new Set<() => void>()

/** Let views that could not be loaded be loaded when they are mounted again; whoever has shown the failure says so. */
export function forgetFailedLoads(): void {
  failed.forEach((again) => again())
  failed.clear()
}

/** A page that is loaded anew without its server is gone, and STOP with it. */
async function isServerThere(): Promise<boolean> {
  try {
    return (await fetch(location.href)).ok
  } catch {
    return false
  }
}

/**
 * Put it inside a `ViewBoundary`, which a failed load is thrown to. Nothing suspends: React 19.3 throws where a boundary
 * that waits for code is taken away before the code has come.
 */
export function lazyView<P extends object>(
  load: () => Promise<ComponentType<P>>,
): ComponentType<P> & { readonly load: () => Promise<unknown> } {
  let loading: Promise<ComponentType<P>> | undefined
  let hasFailed = false
  let loaded: ComponentType<P> | undefined

  function start(): Promise<ComponentType<P>> {
    loading ??= load().then(
      (body) => (loaded = body),
      async (error: unknown) => {
        failed.add(() => (loading = undefined))
        // Some browsers never fetch a module again that they did not get: the page has to be loaded anew.
        if (hasFailed && (await isServerThere())) location.reload()
        hasFailed = true
        throw error
      },
    )
    return loading
  }

  function LazyView(props: P) {
    const [Body, setBody] = useState(() => loaded)
    const [failure, setFailure] = useState<{ readonly error: unknown }>()
    const waiting = useContext(WhileLoading)
    useEffect(() => {
      if (Body) return undefined
      let isShown = true
      start().then(
        (body) => isShown && setBody(() => body),
        (error: unknown) => isShown && setFailure({ error }),
      )
      return () => {
        isShown = false
      }
    }, [Body])
    if (failure) throw failure.error
    return Body ? <Body {...props} /> : waiting
  }
  // For who shows it only once it can be drawn at once.
  return Object.assign(LazyView, { load: start })
}
