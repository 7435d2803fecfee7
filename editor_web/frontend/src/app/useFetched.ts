/** Something fetched from the server, fetched again when its key or revision changes, or the server was restarted. */
import { useEffect, useState } from 'react'
import { ServerError, wordsOf } from '../api/client'
import { useLive } from '../api/live'

export interface Fetched<T> {
  readonly value: T | undefined
  readonly problem: string | undefined
}

export function useFetched<T>(key: string, load: () => Promise<T>, revision: number | string = 0): Fetched<T> {
  const generation = useLive((s) => s.generation)
  const [state, setState] = useState<Fetched<T> & { key: string }>({ key, value: undefined, problem: undefined })
  useEffect(() => {
    let current = true
    load().then(
      (value) => current && setState({ key, value, problem: undefined }),
      // Whoever is logged out keeps what is shown; it is fetched again after the next log-in.
      (error: unknown) => current && !isLoggedOut(error) && setState({ key, value: undefined, problem: wordsOf(error) }),
    )
    return () => {
      current = false
    }
    // oxlint-disable-next-line react/exhaustive-deps -- the key stands for what `load` depends on
  }, [key, generation, revision])
  // What another server process said is shown until this one has answered: nothing typed is lost.
  return state.key === key ? state : { value: undefined, problem: undefined }
}

function isLoggedOut(error: unknown): boolean {
  return error instanceof ServerError && error.status === 401
}
