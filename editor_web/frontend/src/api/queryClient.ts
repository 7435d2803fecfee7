/** What the page knows of the server by asking it: the cache of answers, its rules, and failures in words. */
import { QueryClient, useQuery, useQueryClient, type QueryKey, type UseQueryOptions } from '@tanstack/react-query'
import { useEffect, useRef, useState } from 'react'
import { ServerError, wordsOf } from './client'

const TRIES_AGAIN = 2
const RETRY_MS = 300

export function newQueryClient(): QueryClient {
  return new QueryClient({
    defaultOptions: {
      queries: {
        // A cell has a network of its own: that the browser has no Internet says nothing about the server.
        networkMode: 'always',
        refetchOnWindowFocus: false,
        refetchOnReconnect: false,
        // A refusal is an answer. Only who does not answer at all is asked again.
        retry: (failures, error) => !(error instanceof ServerError) && failures < TRIES_AGAIN,
        retryDelay: RETRY_MS,
      },
      mutations: { networkMode: 'always' },
    },
  })
}

/** What a query has brought, as the page shows it. */
export interface Answer<T> {
  readonly value: T | undefined
  readonly problem: string | undefined
}

/** Ask, and be told of the newest answer; what was answered before stays until then. */
export function useAnswer<T, Key extends QueryKey>(query: UseQueryOptions<T, Error, T, Key>): Answer<T> {
  const { data, error } = useQuery(query)
  return { value: data, problem: problemOf(error) }
}

/** The same; what was answered last, to whichever question, stays until the next answer is there. */
export function useLastAnswer<T, Key extends QueryKey>(query: UseQueryOptions<T, Error, T, Key>): Answer<T> {
  const { value, problem } = useAnswer(query)
  const [last, setLast] = useState(value)
  if (value !== undefined && value !== last) setLast(value)
  return { value: value ?? last, problem }
}

/** Why there is no answer; undefined where there is one. Whoever is logged out keeps what is shown and is asked after the log-in. */
export function problemOf(error: Error | null): string | undefined {
  return error === null || (error instanceof ServerError && error.status === 401) ? undefined : wordsOf(error)
}

/** Let what stands under a key be asked for anew whenever `revision` changes. */
export function useOutdated(queryKey: QueryKey, revision: number | string): void {
  const client = useQueryClient()
  const known = useRef(revision)
  useEffect(() => {
    if (known.current === revision) return
    known.current = revision
    void client.invalidateQueries({ queryKey })
    // oxlint-disable-next-line react/exhaustive-deps -- another key has its own answer
  }, [client, revision])
}
