/** What the live streams tell that makes answers of before out of date. */
import type { QueryClient, QueryKey } from '@tanstack/react-query'
import { lookup } from '../document/dict'
import { isGone } from '../document/live'
import { useLive } from './live'
import type { LiveStore } from './liveStore'
import { queryKeys } from './queryKeys'
import { useTeach } from './teaching'

/** Let answers be asked for anew when they are out of date; returns how to end that. */
export function invalidateByStreams(client: QueryClient): () => void {
  const outdate = (...keys: readonly QueryKey[]) => {
    for (const queryKey of keys) void client.invalidateQueries({ queryKey })
  }
  const endLive = useLive.subscribe((now, before) => {
    if (now.generation !== before.generation) {
      void client.invalidateQueries()
      return
    }
    // Who did not answer while the connection was lost is asked again.
    if (now.connection === 'live' && before.connection !== 'live') void client.refetchQueries({ type: 'active', predicate: hasFailed })
    if (now.documents !== before.documents && changedDocuments(now, before).length > 0) {
      const changed = changedDocuments(now, before)
      outdate(queryKeys.behaviors, queryKeys.deleted, ...changed.filter((id) => !isGone(now, id)).map(queryKeys.document))
      // Of a document that is gone there is no answer.
      void client.invalidateQueries({ queryKey: queryKeys.referrers, predicate: ({ queryKey }) => !isGone(now, String(queryKey[1])) })
    }
    // Classes of states say what can be put where, and what is wrong with every behavior.
    if (now.statesRevision !== before.statesRevision) outdate(queryKeys.catalogue, queryKeys.behaviors, queryKeys.everyBehavior)
    if (now.runs !== before.runs) {
      if (now.runs.length !== before.runs.length) outdate(queryKeys.interrupted)
      if (statuses(now) !== statuses(before)) outdate(queryKeys.pastRuns)
    }
    if (now.sweeps !== before.sweeps && idleSweeps(now) !== idleSweeps(before)) outdate(queryKeys.sweeps)
  })
  const endTeach = useTeach.subscribe((now, before) => {
    if (now.entries > before.entries) outdate(queryKeys.entries)
  })
  return () => {
    endLive()
    endTeach()
  }
}

function hasFailed(query: { readonly state: { readonly status: string } }): boolean {
  return query.state.status === 'error'
}

function changedDocuments(now: LiveStore, before: LiveStore): readonly string[] {
  const ids = new Set([...Object.keys(now.documents), ...Object.keys(before.documents)])
  return [...ids].filter((id) => lookup(now.documents, id) !== lookup(before.documents, id))
}

function statuses({ runs }: LiveStore): string {
  return runs.map((run) => run.status).join(' ')
}

function idleSweeps({ sweeps }: LiveStore): number {
  return Object.values(sweeps).filter((each) => each?.status === 'idle').length
}
