/** What the page has asked the server, for all that stands inside; kept up with what the live streams tell. */
import { QueryClientProvider, type QueryClient } from '@tanstack/react-query'
import { useEffect, type ReactNode } from 'react'
import { invalidateByStreams } from '../api/invalidation'

export interface ServerAnswersProps {
  readonly client: QueryClient
  readonly children: ReactNode
}

export function ServerAnswers({ client, children }: ServerAnswersProps) {
  useEffect(() => invalidateByStreams(client), [client])
  return <QueryClientProvider client={client}>{children}</QueryClientProvider>
}
