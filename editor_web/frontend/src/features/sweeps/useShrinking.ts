/** How far a run is shrunk, as the server tells it; asked again as long as it goes on. */
import { useMutation, useQueryClient } from '@tanstack/react-query'
import { problemOf, useAnswer } from '../../api/queryClient'
import { sweepQueries } from '../../api/sweeps'
import type { Shrinking } from '../../api/types'

export interface RunShrinking {
  readonly shrinking: Shrinking | undefined
  /** Why the last request was refused. */
  readonly problem: string
  /** Ask for something, and then how far it is. */
  readonly request: (asked: () => Promise<unknown>) => Promise<void>
}

export function useShrinking(sweep: string, number: number): RunShrinking {
  const client = useQueryClient()
  const query = sweepQueries.shrinking(sweep, number)
  const { value: shrinking, problem: unread } = useAnswer(query)
  const { mutateAsync, error } = useMutation({
    mutationFn: (asked: () => Promise<unknown>) => asked(),
    onSuccess: () => void client.invalidateQueries({ queryKey: query.queryKey }),
  })

  async function request(asked: () => Promise<unknown>): Promise<void> {
    // Why it was refused is told by the mutation.
    await mutateAsync(asked).catch(() => undefined)
  }

  return { shrinking, problem: problemOf(error) ?? unread ?? '', request }
}
