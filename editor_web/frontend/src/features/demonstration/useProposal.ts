/** Asks for the proposal of the steps as they are, a moment after the last change; the newest answer counts. */
import { skipToken } from '@tanstack/react-query'
import { useDebouncedValue } from '@mantine/hooks'
import { proposalQuery } from '../../api/demonstration'
import { useLastAnswer } from '../../api/queryClient'
import type { DemonstrationBody, ProposalBody } from '../../api/types'

const PAUSE_MS = 150
const NO_BODY = {} as DemonstrationBody

export interface Proposed {
  readonly proposal?: ProposalBody
  readonly problem?: string
}

export function useProposal(body: DemonstrationBody | undefined): Proposed {
  const [asked] = useDebouncedValue(body && JSON.stringify(body), PAUSE_MS)
  const query = proposalQuery(asked === undefined ? NO_BODY : (JSON.parse(asked) as DemonstrationBody))
  const { value, problem } = useLastAnswer({ ...query, ...(asked === undefined && { queryFn: skipToken }) })
  if (asked === undefined) return {}
  if (problem !== undefined) return { problem }
  return value ? { proposal: value } : {}
}
